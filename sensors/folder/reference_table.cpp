// Reads the reference of a drive of tables.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "msgs/frames.h"
#include "sensors/folder/table_reader.h"

namespace maploop::sensors {
namespace {

// Refuses positions that no vehicle can come from and go on to: one, or all between a leap and the
// leap back.
void leave_out_leaps(TableRows<ReferencePose>& rows, const NumberTable& table) {
  constexpr double fastest_car = 100.0, noise = 10.0;  // m/s, m
  constexpr Duration longest = std::chrono::seconds(10);
  std::vector<std::size_t> known;
  known.reserve(rows.samples.size());
  for (std::size_t i = 0; i < rows.samples.size(); ++i) {
    if (!rows.verdicts[i]) known.push_back(i);
  }
  const auto leaps = [&](std::size_t from, std::size_t to) {
    const ReferencePose& a = rows.samples[known[from]];
    const ReferencePose& b = rows.samples[known[to]];
    const double way = LocalFrame(a.position).to_enu(b.position).head<2>().norm();
    return way > noise + fastest_car * to_seconds(b.stamp - a.stamp);
  };
  for (std::size_t k = 1; k < known.size(); ++k) {
    if (!leaps(k - 1, k)) continue;
    const Time end = rows.samples[known[k - 1]].stamp + longest;
    std::size_t back = k + 1;
    const auto near = [&] { return back < known.size() && rows.samples[known[back]].stamp <= end; };
    while (near() && leaps(k - 1, back)) ++back;
    if (!near()) continue;
    for (; k < back; ++k) {
      rows.verdicts[known[k]] =
          Finding{rows.file.string(), table.line(known[k]), "the position leaps there and back"};
    }
  }
}

// Gives each position the attitude of its time.
void join(TableRows<ReferencePose>& poses, const NumberTable& table,
          const TableRows<ReferencePose>& attitudes) {
  constexpr Duration apart = std::chrono::milliseconds(20);  // at most
  std::vector<const ReferencePose*> known;
  for (std::size_t i = 0; i < attitudes.samples.size(); ++i) {
    if (!attitudes.verdicts[i]) known.push_back(&attitudes.samples[i]);
  }
  const auto earlier = [](const ReferencePose* a, Time t) { return a->stamp < t; };
  for (std::size_t i = 0; i < poses.samples.size(); ++i) {
    if (poses.verdicts[i]) continue;
    ReferencePose& pose = poses.samples[i];
    const auto after = std::lower_bound(known.begin(), known.end(), pose.stamp, earlier);
    const auto is_near = [&](const ReferencePose* a) {
      return input_limits::within(apart, a->stamp, pose.stamp);
    };
    if (after != known.end() && is_near(*after)) {
      pose.attitude = (*after)->attitude;
    } else if (after != known.begin() && is_near(*(after - 1))) {
      pose.attitude = (*(after - 1))->attitude;
    } else {
      poses.verdicts[i] =
          Finding{poses.file.string(), table.line(i), "has no attitude at its time"};
    }
  }
}

void want_attitude(std::vector<WantedColumn>& wanted, const ReferenceTable& t) {
  if (t.quaternion.given()) return want(wanted, t.quaternion, -1.01, 1.01);
  constexpr std::array<double, 3> most{180.0, 90.0, 360.0};
  for (std::size_t k = 0; k < t.attitude.names.size(); ++k)
    wanted.push_back({t.attitude.names[k], t.attitude.unit, -most[k], most[k]});
}

void set_attitude(const ReferenceTable& t, TableValues v, ReferencePose& pose) {
  if (t.quaternion.given()) {
    const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
    if (std::abs(q.norm() - 1.0) > 0.01)
      throw std::invalid_argument("the quaternion is not a unit");
    pose.attitude = attitude_from_rotation(q.normalized().toRotationMatrix() * t.R_unit_body);
    return;
  }
  // A receiver that has not aligned its unit states zeros.
  if (v[0] == 0.0 && v[2] == 0.0) throw std::invalid_argument("the receiver had not aligned yet");
  pose.attitude = {wrap_angle(radians(v[2])), radians(v[1]), radians(v[0])};
}

}  // namespace

std::shared_ptr<const TableRows<ReferencePose>> read_reference(const TableMapping& mapping,
                                                               std::optional<Time>& start) {
  const ReferenceTable& t = mapping.reference;
  const OpenedTable opened(t, mapping);
  if (!start) start = opened.clock.start();
  const bool joined = t.attitude_file.given();
  std::vector<WantedColumn> wanted, turned;
  want_position(wanted, t.form, t.position);
  want(wanted, t.velocity, -fastest_receiver, fastest_receiver);
  want_attitude(joined ? turned : wanted, t);
  const auto fill = [&](TableValues v, ReferencePose& pose) {
    pose.position = place(t.form, v);
    v = v.subspan(3);
    pose.velocity_stamp = pose.stamp;
    pose.position_accuracy = t.accuracy;
    if (t.velocity.given()) {
      pose.velocity_enu = velocity_enu(t.velocity_axes, v, pose.position);
      v = v.subspan(3);
    }
    if (!joined) set_attitude(t, v, pose);
  };
  const auto poses = read_rows<ReferencePose>(opened.table, opened.clock, *start, wanted, fill);
  if (t.peer) leave_out_leaps(*poses, opened.table);
  if (joined) {
    const OpenedTable attitudes(t.attitude_file, mapping);
    join(*poses, opened.table,
         *read_rows<ReferencePose>(
             attitudes.table, attitudes.clock, *start, turned,
             [&](TableValues v, ReferencePose& pose) { set_attitude(t, v, pose); }));
  }
  return poses->first() != nullptr ? poses : nullptr;
}

}  // namespace maploop::sensors
