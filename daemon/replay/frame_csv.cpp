#include "daemon/replay/frame_csv.hpp"

#include "daemon/replay/csv_field.hpp"

namespace hulltrack {
namespace {

void append_pose(std::string& line, const TrackResult& r) {
  if (!r.registered) {
    line += ",,,,,,";
    return;
  }
  for (const double v : r.pose.displacement()) {
    append_field(line, v);
  }
  for (const double v : r.pose.rpy()) {
    append_field(line, degrees(v));
  }
}

void append_metrics(std::string& line, const DistanceMetrics& m) {
  if (!m.valid) {
    line += ",,,,,";
    return;
  }
  for (const double v : {m.q1, m.mean, m.median, m.q3, m.rms}) {
    append_field(line, v);
  }
}

void append_motion(std::string& line, const MotionProducts& motion) {
  if (motion.now) {
    for (const double v :
         {motion.now->draft, degrees(motion.now->heel), degrees(motion.now->trim), motion.now->surge}) {
      append_field(line, v);
    }
  } else {
    line += ",,,,";
  }
  if (motion.rate) {
    constexpr double kHour = 3600.0;
    constexpr double kMinute = 60.0;
    for (const double v : {motion.rate->draft * kHour, degrees(motion.rate->heel) * kHour,
                           degrees(motion.rate->trim) * kHour, motion.rate->surge * kMinute}) {
      append_field(line, v);
    }
  } else {
    line += ",,,,";
  }
}

void append_bend(std::string& line, const TrackResult& r) {
  if (r.sigma_bend < 0.0) {
    line += ",,";
    return;
  }
  append_field(line, r.bend);
  append_field(line, r.sigma_bend);
}

void append_covariance(std::string& line, const TrackResult& r) {
  const bool known = r.sigma_translation >= 0.0 && !r.covariance.isZero(0.0);
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      if (known) {
        append_field(line, r.covariance(row, column));
      } else {
        line += ',';
      }
    }
  }
}

}  // namespace

std::string frame_csv_line(const TrackResult& r, std::optional<double> processing_ms) {
  std::string line;
  append_field(line, r.frame);
  append_field(line, to_ns(r.time));
  append_field(line, static_cast<unsigned>(r.state));
  append_field(line, r.health ? 1 : 0);
  append_field(line, unsigned{r.faults});
  append_pose(line, r);
  append_metrics(line, r.metrics);
  append_field(line, r.matched);
  append_field(line, r.sigma_translation);
  append_field(line, r.sigma_rotation < 0.0 ? r.sigma_rotation : degrees(r.sigma_rotation));
  append_field(line, r.iterations);
  if (processing_ms) {
    append_field(line, *processing_ms);
  } else {
    line += ',';
  }
  append_motion(line, r.motion);
  append_bend(line, r);
  append_covariance(line, r);
  if (r.metrics.q1_expected) {
    append_field(line, *r.metrics.q1_expected);
  } else {
    line += ',';
  }
  append_words(line, r.health ? std::string{} : r.reason);
  line.pop_back();
  return line;
}

}  // namespace hulltrack
