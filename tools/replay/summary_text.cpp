// The tables at the end of a run.
#include <fmt/format.h>

#include <algorithm>

#include "tools/match/match_score.h"
#include "tools/profile/profile.h"
#include "tools/replay/figures.h"

namespace maploop::tools {
namespace {

void append_accuracy(std::string& text, const char* name, const std::optional<Accuracy>& accuracy) {
  text +=
      fmt::format("  {:8}{}\n", name,
                  accuracy ? web::to_text(accuracy_columns, *accuracy) : " too few poses to score");
}

void append_ppp(std::string& text, const PppEpochs& e) {
  const std::size_t fixed = e.of(PppStatus::fixed);
  text += fmt::format(
      "\nPrecise point positioning: {} epochs converged{}, {} converging, {} without a position",
      e.of(PppStatus::converged) + fixed,
      fixed > 0 ? fmt::format(" ({} with integer ambiguities)", fixed) : "",
      e.of(PppStatus::converging), e.of(PppStatus::none));
  if (e.converged_after >= 0.0)
    text += fmt::format("; converged after {:.0f} s", e.converged_after);
  if (e.never_converges)
    text += "\n  (on one frequency with broadcast orbits it cannot converge to 0.1 m)";
  text += '\n';
}

void append_latency(std::string& text, const LatencySummary& s) {
  text += fmt::format("  {:22} {:7} {:9.3f} {:9.3f} {:9.3f} {:9.3f}", s.name, s.count,
                      to_milliseconds(s.p50), to_milliseconds(s.p90), to_milliseconds(s.p99),
                      to_milliseconds(s.max));
  if (s.deadline > Duration::zero()) {
    text += fmt::format(" {:9.0f} {:7}", to_milliseconds(s.deadline), s.misses);
  }
  text += '\n';
}

void append_worst(std::string& text, const std::vector<LatencySummary>& summaries) {
  constexpr std::size_t shown = 5;
  for (const LatencySummary& s : summaries) {
    for (std::size_t i = 0; i < std::min(s.worst.size(), shown); ++i) {
      const MissedDeadline& m = s.worst[i];
      text += fmt::format("  missed: {} at {}: {:.3f} ms ({})\n", s.name, format_time(m.stamp),
                          to_milliseconds(m.latency), profile::parts_text(m));
    }
  }
}

void append_findings(std::string& text, const vehicle::SensorReport& sensor) {
  constexpr std::size_t shown = 5;
  const auto append_some = [&](const std::vector<sensors::Finding>& findings, std::uint64_t count,
                               const char* what) {
    for (std::size_t i = 0; i < findings.size() && i < shown; ++i) {
      const sensors::Finding& f = findings[i];
      text += "  " + std::string(what) + ": " + f.file;
      if (f.line > 0) text += ":" + std::to_string(f.line);
      text += ": " + f.reason + '\n';
    }
    if (count > shown) text += fmt::format("  ... {} {} of {} in all\n", count, what, sensor.name);
  };
  append_some(sensor.source.refusals, sensor.source.refused, "left out");
  append_some(sensor.source.flaws, sensor.source.flawed, "flawed");
}

void append_faults(std::string& text, const std::vector<vehicle::FaultCount>& faults) {
  if (faults.empty()) return;
  text += "\nFaults asked for                  struck\n";
  for (const vehicle::FaultCount& f : faults) {
    text += ' ' + web::to_text(fault_columns, f);
    if (f.struck == 0) text += "  (outside of the drive, or the drive lacks the sensor)";
    text += '\n';
  }
}

void append_live(std::string& text, const std::vector<SensorHealth>& sensors) {
  if (sensors.empty()) return;
  text += "\nLive             connected   drift ppm   jumps   UTC ahead of the host's  s\n";
  for (const SensorHealth& s : sensors) {
    text += fmt::format("  {:12} {:9} x", s.name, s.connections);
    if (s.clock.known) {
      text += fmt::format(" {:11.2f} {:7}", -1e6 * s.clock.drift, s.clock.jumps);
      if (s.clock.utc_ahead) text += fmt::format("   {:.6f}", to_seconds(*s.clock.utc_ahead));
    }
    text += "   " + s.endpoint + (s.problem.empty() ? "" : ": " + s.problem) + '\n';
  }
}

void append_refusals(std::string& text, const std::vector<RefusalCount>& refusals) {
  if (!refusals.empty()) text += "\nNot used by         count\n";
  for (const RefusalCount& r : refusals) {
    text += ' ' + web::to_text(refusal_columns, r) + "  " + r.reason + '\n';
  }
}

void append_channels(std::string& text,
                     const std::map<std::string, vehicle::ChannelSummary>& channels) {
  for (const auto& [name, channel] : channels) {
    text += fmt::format("  {:11} {:9}  {}\n", name, channel.count,
                        channel.hash.empty() ? "(of this run)" : channel.hash);
  }
}

void append_calibration(std::string& text, const fusion::SelfCalibrations& calibration) {
  if (calibration.front().sigma == 0.0) return;
  text += "\nEstimated on the way\n";
  for (const fusion::CalibratedProperty& c : calibration) {
    text += fmt::format("  {:42} {:9.3f} +- {:.3f} {}{}\n", c.name, c.value, c.sigma, c.unit,
                        c.observed() ? "" : ", not observed yet");
  }
}

void append_accuracies(std::string& text, const ReplayResult& r) {
  if (r.vo || r.fused) {
    text +=
        "\nAccuracy against the reference (left camera, WGS84)\n"
        "                  distance   end point      100 m segments   common rotation removed\n"
        "           frames        m        m      %        %     deg/m            %     deg/m"
        "  end m\n";
    append_accuracy(text, "vo", r.vo);
    if (r.lidar) append_accuracy(text, "lidar", r.lidar);
    append_accuracy(text, "odom", r.odom);
    append_accuracy(text, "fused", r.fused);
  } else if (!r.navigation && !r.live) {
    text += "\nAccuracy is not scored: the drive has no reference, or too few poses\n";
  }
  append_calibration(text, r.vehicle.calibration);
  if (r.navigation) text += fusion_score::to_text(*r.navigation);
  if (r.protection) text += fusion_score::to_text(*r.protection);
  if (r.links) text += "\nLinks driven against their labels\n" + match::to_text(*r.links);
  if (r.ppp) append_ppp(text, *r.ppp);
}

std::string lateness_text(const LatencySummary& s) {
  return fmt::format("  {:9.3f} {:9.3f} {:9.3f}", to_milliseconds(s.p50), to_milliseconds(s.p99),
                     to_milliseconds(s.max));
}

// Samples are late only if they are released by a clock.
void append_sensors(std::string& text, const vehicle::VehicleReport& v, bool on_a_clock) {
  text += "\nSensors                 count  left out   late p50       p99       max  ms\n";
  for (const vehicle::SensorReport& s : v.sensors) {
    text += ' ' + web::to_text(sensor_columns, s);
    text += (on_a_clock ? lateness_text(s.lateness) : std::string()) + '\n';
    append_findings(text, s);
  }
  if (!on_a_clock) return;
  text +=
      fmt::format("  {:19} {:7} {:9}{}\n", "all", v.lateness.count, "", lateness_text(v.lateness));
}

void append_latencies(std::string& text, const Deadlines& deadlines, bool on_a_clock) {
  text += on_a_clock
              ? "\nFrom release             count       p50       p90       p99       max"
                "  deadline  missed  ms\n"
              : "\nRun time                 count       p50       p90       p99       max  ms\n";
  for (const LatencySummary& s : deadlines.threads) append_latency(text, s);
  if (!on_a_clock) return;
  text += "From the sensor's stamp\n";
  for (const LatencySummary& s : deadlines.paths) append_latency(text, s);
  append_worst(text, deadlines.threads);
  append_worst(text, deadlines.paths);
}

}  // namespace

std::string format_table(const ReplayResult& r) {
  const vehicle::VehicleReport& v = r.vehicle;
  const std::string pace = r.live       ? "live"
                           : r.lockstep ? "lockstep"
                                        : "speed " + std::to_string(r.speed);
  std::string text =
      fmt::format("\n{}{}: {:.1f} s of data in {:.1f} s ({})\n", r.drive,
                  r.interrupted ? " (interrupted)" : "", v.data_seconds, v.wall_seconds, pace);
  text += fmt::format("CPU {:.0f} % of one core, peak memory {:.0f} MB\n",
                      100.0 * v.cpu_seconds / v.wall_seconds,
                      static_cast<double>(v.peak_memory) * 1e-6);
  append_accuracies(text, r);
  append_sensors(text, v, !r.lockstep);
  append_live(text, v.health.sensors);
  append_faults(text, r.faults);
  append_refusals(text, v.health.refusals);
  append_latencies(text, v.deadlines, !r.lockstep);
  text += "\nRings                                pushed    popped      lost      held  capacity\n";
  for (const RingHealth& ring : v.health.rings)
    text += ' ' + web::to_text(ring_columns, ring) + '\n';
  text += "\nChannels      messages  hash\n";
  append_channels(text, r.channels);
  if (r.snapshot) {
    text +=
        fmt::format("\nAfter the snapshot at {:.3f} s ({}), and of a run that resumes from it\n",
                    r.snapshot->at, r.snapshot->file);
    append_channels(text, r.snapshot->channels);
  }
  if (r.trace) {
    text += fmt::format("\nTrace: {} events in {}, {} dropped\n", r.trace->recorded, r.trace->file,
                        r.trace->dropped);
  }
  for (const std::string& sentence : v.health.degraded) text += "\nNote: " + sentence + '\n';
  return text;
}

}  // namespace maploop::tools
