#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "mapmatch/reasons.h"
#include "msgs/frames.h"
#include "tools/evaluation/text_file.h"
#include "tools/match/match_output.h"

namespace maploop::match {
namespace {

using nlohmann::json;

constexpr double surroundings = 250.0;  // m about the track that are drawn

double centimetres(double metres) {
  return std::round(100.0 * metres) / 100.0;
}

json point(const Eigen::Vector2d& p) {
  return {centimetres(p.x()), centimetres(p.y())};
}

json links_about(const mapmatch::RoadNetwork& network, const mapmatch::Box& box) {
  std::vector<bool> inside(network.size(), false);
  network.index().visit(box, [&](const mapmatch::IndexedSegment& s) { inside[s.link] = true; });
  json links = json::object();
  for (std::uint32_t i = 0; i < network.size(); ++i) {
    if (!inside[i]) continue;
    json shape = json::array();
    for (const mapmatch::Vertex& v : network.shape(i)) shape.push_back(point(v.position()));
    const mapmatch::Link& link = network.link(i);
    const mapmatch::Road& road = network.road_at(link.first_vertex);
    const char* direction = link.forward ? (link.backward ? "" : ", one way") : ", one way";
    links[std::to_string(i)] = {
        {"p", shape},
        {"c", static_cast<int>(road.road_class)},
        {"n", road.name + " (way " + std::to_string(road.way_id) + ", " +
                  std::string(to_string(road.road_class)) + direction + ")"}};
  }
  return links;
}

class RuleTexts {
 public:
  int index(const std::string& text) {
    const auto [found, added] = indices_.emplace(text, static_cast<int>(texts_.size()));
    if (added) texts_.push_back(text);
    return found->second;
  }
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::map<std::string, int> indices_;
  std::vector<std::string> texts_;
};

json candidates_of(const mapmatch::MatchResult& r, const mapmatch::RoadNetwork& network,
                   const mapmatch::RuleBases& rules, RuleTexts& texts) {
  json candidates = json::array();
  for (std::size_t i = 0; i < std::min<std::size_t>(r.candidate_count, 8); ++i) {
    const mapmatch::MatchCandidate& c = r.candidates[i];
    json fired = json::array();
    for (const auto& [text, weight] : fired_rules(c, rules))
      fired.push_back({texts.index(text), std::round(100.0 * weight) / 100.0});
    candidates.push_back({{"l", c.link.link},
                          {"at", point(network.at(c.link, c.along).position)},
                          {"L", std::round(10.0 * c.likelihood) / 10.0},
                          {"P", std::round(1e4 * c.probability) / 1e4},
                          {"why", objections(c, network)},
                          {"r", fired}});
  }
  return candidates;
}

json fixes_of(const MatchedTrack& track, const mapmatch::RoadNetwork& network,
              const mapmatch::RuleBases& rules, RuleTexts& texts) {
  json fixes = json::array();
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const mapmatch::MatchResult& r = track.results[i];
    if (r.refusal == mapmatch::FixRefusal::not_finite) continue;
    const bool matched = r.on_road && r.refusal == mapmatch::FixRefusal::none;
    json fix{{"t", to_seconds(track.fixes[i].stamp - track.fixes.front().stamp)},
             {"p", point(network.to_local(track.fixes[i].position))},
             {"ph", to_string(r.phase)},
             {"say", explanation(r, network)},
             {"c", candidates_of(r, network, rules, texts)}};
    if (matched) {
      fix["m"] = point(r.point.position);
      fix["P"] = std::round(1e4 * r.probability) / 1e4;
    }
    fixes.push_back(std::move(fix));
  }
  return fixes;
}

mapmatch::Box box_of(const MatchedTrack& track, const mapmatch::RoadNetwork& network) {
  constexpr double far = std::numeric_limits<double>::infinity();
  mapmatch::Box box{far, far, -far, -far};
  for (const mapmatch::VehicleFix& fix : track.fixes) {
    const Eigen::Vector2d p = network.to_local(fix.position);
    if (!p.allFinite()) continue;
    box = {std::min(box.west, p.x() - surroundings), std::min(box.south, p.y() - surroundings),
           std::max(box.east, p.x() + surroundings), std::max(box.north, p.y() + surroundings)};
  }
  return box;
}

// Inside a script element "</" would end it.
std::string script_safe(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.replace(at, 2, "<\\/");
  return text;
}

constexpr const char* page_head = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>maploop match</title>
<meta name="viewport" content="width=device-width,initial-scale=1">
<style>
html,body{margin:0;height:100%;font:14px/1.45 system-ui,sans-serif;color:#1c2430;background:#f6f5f2}
canvas{position:fixed;inset:0;width:100%;height:100%;cursor:grab}
#panel{position:fixed;top:12px;right:12px;width:380px;max-height:calc(100% - 24px);overflow:auto;
background:#fffffff2;border-radius:10px;box-shadow:0 2px 14px #0003;padding:12px 16px;box-sizing:border-box}
#panel h1{font-size:15px;margin:0 0 4px}#panel table{border-collapse:collapse;width:100%;margin-top:6px}
#panel td,#panel th{text-align:left;padding:2px 4px;border-top:1px solid #ddd;vertical-align:top;font-size:13px}
.rule{color:#667;font-size:12px}.key i{display:inline-block;width:10px;height:10px;border-radius:5px;margin:0 4px 0 10px}
</style></head><body><canvas id="map"></canvas><div id="panel"><h1>maploop match</h1>
<div class="key">P(link)<i style="background:#1a9850"></i>high<i style="background:#f2a900"></i>middling
<i style="background:#d73027"></i>low<i style="background:#7a5cc7"></i>off road</div>
<p>Drag to move, wheel to zoom, click a fix; arrow keys go to the next and the one before.</p><div id="one"></div></div>
<script>
const data=)";

constexpr const char* page_tail = R"(;
const canvas=document.getElementById('map'),g=canvas.getContext('2d'),one=document.getElementById('one');
let scale=1,cx=0,cy=0,chosen=-1,drag=null;
const fixes=data.fixes,links=data.links;
const X=p=>canvas.width/2+(p[0]-cx)*scale,Y=p=>canvas.height/2-(p[1]-cy)*scale;
const width=c=>c<4?7:c<8?5.5:c<10?4.5:c<13?3.5:2.2;
function colour(f){return f.m===undefined?'#7a5cc7':f.P>.9?'#1a9850':f.P>.6?'#f2a900':'#d73027';}
function line(ps){g.beginPath();ps.forEach((p,i)=>i?g.lineTo(X(p),Y(p)):g.moveTo(X(p),Y(p)));g.stroke();}
function draw(){
  const d=devicePixelRatio||1;g.clearRect(0,0,canvas.width,canvas.height);g.lineCap=g.lineJoin='round';
  const grow=Math.max(.5,Math.min(3,scale/d/2))*d;
  for(const id in links){g.strokeStyle='#b9b6ae';g.lineWidth=(width(links[id].c)+1.2)*grow;line(links[id].p);}
  for(const id in links){g.strokeStyle=links[id].c>13?'#f0ede6':'#fff';g.lineWidth=width(links[id].c)*grow;line(links[id].p);}
  if(chosen>=0)for(const c of fixes[chosen].c.slice().reverse())if(links[c.l]){
    g.strokeStyle=`rgba(30,110,220,${.25+.65*c.P})`;g.lineWidth=4*grow;line(links[c.l].p);}
  g.lineWidth=d;fixes.forEach(f=>{if(!f.m)return;g.strokeStyle='#8888';line([f.p,f.m]);});
  fixes.forEach((f,i)=>{g.fillStyle=colour(f);g.beginPath();
    g.arc(X(f.p),Y(f.p),(i===chosen?7:3.5)*d,0,7);g.fill();});
}
function cell(row,text,name){const e=row.appendChild(document.createElement(name||'td'));e.textContent=text;return e;}
function show(i){chosen=i;const f=fixes[i];one.textContent='';
  const h=one.appendChild(document.createElement('h1'));h.textContent=`Fix ${i+1} of ${fixes.length}, ${f.t.toFixed(2)} s, ${f.ph}`;
  one.appendChild(document.createElement('div')).textContent=f.say;
  const t=one.appendChild(document.createElement('table')),r=t.insertRow();['link','P','L'].forEach(x=>cell(r,x,'th'));
  for(const c of f.c){const r=t.insertRow(),e=cell(r,links[c.l]?links[c.l].n:'link '+c.l);cell(r,c.P.toFixed(3));cell(r,c.L.toFixed(0));
    if(c.why.length)e.appendChild(document.createElement('div')).textContent=c.why.join('; ');
    for(const [k,w] of c.r){const x=e.appendChild(document.createElement('div'));x.className='rule';x.textContent=w.toFixed(2)+'  '+data.rules[k];}}
  draw();}
function fit(){const d=devicePixelRatio||1;canvas.width=innerWidth*d;canvas.height=innerHeight*d;draw();}
canvas.onmousedown=e=>{drag=[e.clientX,e.clientY,cx,cy,false];};
onmousemove=e=>{if(!drag)return;const d=devicePixelRatio||1,dx=e.clientX-drag[0],dy=e.clientY-drag[1];
  if(Math.abs(dx)+Math.abs(dy)>3)drag[4]=true;cx=drag[2]-dx*d/scale;cy=drag[3]+dy*d/scale;draw();};
onmouseup=e=>{const was=drag;drag=null;if(!was||was[4]||e.target!==canvas)return;const d=devicePixelRatio||1;let best=-1,near=400*d*d;
  fixes.forEach((f,i)=>{const q=(X(f.p)-e.clientX*d)**2+(Y(f.p)-e.clientY*d)**2;if(q<near){near=q;best=i;}});if(best>=0)show(best);};
canvas.onwheel=e=>{e.preventDefault();const d=devicePixelRatio||1,k=Math.exp(-e.deltaY*.0015),mx=(e.clientX*d-canvas.width/2)/scale,my=(canvas.height/2-e.clientY*d)/scale;
  cx+=mx-mx/k;cy+=my-my/k;scale*=k;draw();};
onkeydown=e=>{const k={ArrowRight:1,ArrowLeft:-1}[e.key];if(k&&fixes.length)show((chosen+k+fixes.length)%fixes.length);};
onresize=fit;
if(fixes.length){const xs=fixes.map(f=>f.p[0]),ys=fixes.map(f=>f.p[1]);
  const lo=a=>a.reduce((m,v)=>Math.min(m,v),1e99),hi=a=>a.reduce((m,v)=>Math.max(m,v),-1e99);
  cx=(lo(xs)+hi(xs))/2;cy=(lo(ys)+hi(ys))/2;const d=devicePixelRatio||1;
  scale=.85*d*Math.min(innerWidth/(hi(xs)-lo(xs)+60),innerHeight/(hi(ys)-lo(ys)+60));}
fit();
</script></body></html>
)";

}  // namespace

void write_match_html(const std::filesystem::path& file, const MatchedTrack& track,
                      const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules) {
  RuleTexts texts;
  json data{{"fixes", fixes_of(track, network, rules, texts)},
            {"links", links_about(network, box_of(track, network))}};
  data["rules"] = texts.texts();
  // Names in a map may hold anything, also what is no UTF-8.
  const std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  evaluation::write_text(file, page_head + script_safe(text) + page_tail);
}

}  // namespace maploop::match
