#include "daemon/replay/joint_csv.hpp"

#include <cmath>

#include "daemon/replay/csv_field.hpp"

namespace hulltrack {

std::string joint_csv_line(const TrackResult& r) {
  std::string line;
  append_field(line, r.frame);
  append_field(line, to_ns(r.time));
  for (const JointName joint : kAllJoints) {
    const JointDoubt& doubt = r.joint_doubts.at(static_cast<std::size_t>(joint));
    if (std::isfinite(doubt.hidden)) {
      const double unit = joint == JointName::travel ? 1.0 : degrees(1.0);
      append_field(line, unit * doubt.reads_too_much);
      append_field(line, unit * doubt.hidden);
    } else {
      line += ",,";
    }
    append_field(line, std::uint64_t{doubt.finds_large});
  }
  line.pop_back();
  return line;
}

}  // namespace hulltrack
