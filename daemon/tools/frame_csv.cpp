#include "daemon/tools/frame_csv.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

namespace hulltrack {
namespace {

template <typename Number>
void append(std::string& line, Number value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  line.append(text.data(), end).push_back(',');
}

void append_pose(std::string& line, const TrackResult& r) {
  if (!r.registered) {
    line += ",,,,,,";
    return;
  }
  for (const double v : r.displacement) {
    append(line, v);
  }
  for (const double v : r.rpy) {
    append(line, degrees(v));
  }
}

void append_metrics(std::string& line, const DistanceMetrics& m) {
  if (!m.valid) {
    line += ",,,,,";
    return;
  }
  for (const double v : {m.q1, m.mean, m.median, m.q3, m.rms}) {
    append(line, v);
  }
}

void append_motion(std::string& line, const MotionProducts& motion) {
  if (motion.now) {
    for (const double v :
         {motion.now->draft, degrees(motion.now->heel), degrees(motion.now->trim), motion.now->surge}) {
      append(line, v);
    }
  } else {
    line += ",,,,";
  }
  if (motion.rate) {
    constexpr double kHour = 3600.0;
    constexpr double kMinute = 60.0;
    for (const double v : {motion.rate->draft * kHour, degrees(motion.rate->heel) * kHour,
                           degrees(motion.rate->trim) * kHour, motion.rate->surge * kMinute}) {
      append(line, v);
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
  append(line, r.bend);
  append(line, r.sigma_bend);
}

void append_covariance(std::string& line, const TrackResult& r) {
  const bool known = r.sigma_translation >= 0.0 && !r.covariance.isZero(0.0);
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      if (known) {
        append(line, r.covariance(row, column));
      } else {
        line += ',';
      }
    }
  }
}

}  // namespace

std::string frame_csv_line(const TrackResult& r, std::optional<double> processing_ms) {
  std::string line;
  append(line, r.frame);
  append(line, to_ns(r.time));
  append(line, static_cast<unsigned>(r.state));
  append(line, r.health ? 1 : 0);
  append(line, unsigned{r.faults});
  append_pose(line, r);
  append_metrics(line, r.metrics);
  append(line, r.matched);
  append(line, r.sigma_translation);
  append(line, r.sigma_rotation < 0.0 ? r.sigma_rotation : degrees(r.sigma_rotation));
  append(line, r.iterations);
  if (processing_ms) {
    append(line, *processing_ms);
  } else {
    line += ',';
  }
  append_motion(line, r.motion);
  append_bend(line, r);
  append_covariance(line, r);
  if (r.metrics.q1_expected) {
    append(line, *r.metrics.q1_expected);
  } else {
    line += ',';
  }
  line.pop_back();
  return line;
}

Result<FrameCsv> FrameCsv::create(const std::filesystem::path& file) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) {
    return Error{file.string() + ": " + std::strerror(errno) + "; choose another file with --csv"};
  }
  FrameCsv csv(file.string(), stream);
  if (Result<void> written = csv.put(kFrameCsvHeader); !written) {
    return written.error();
  }
  return csv;
}

Result<void> FrameCsv::write(const TrackResult& result, std::optional<double> processing_ms) {
  return put(frame_csv_line(result, processing_ms));
}

Result<void> FrameCsv::put(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), stream_.get()) != line.size() ||
      std::fputc('\n', stream_.get()) == EOF) {
    return Error{name_ + ": " + std::strerror(errno)};
  }
  return {};
}

Result<void> FrameCsv::close() {
  if (std::fclose(stream_.release()) != 0) {
    return Error{name_ + ": " + std::strerror(errno)};
  }
  return {};
}

}  // namespace hulltrack
