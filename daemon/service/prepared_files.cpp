#include "daemon/service/prepared_files.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

#include "core/io/map_file.hpp"
#include "daemon/service/memory_file.hpp"

namespace hulltrack {
namespace {

constexpr std::string_view kMagic = "HULLPRE2";
constexpr std::uint64_t kMaxProblems = 100'000;  // a configuration of 1 MiB has fewer lines with a key
constexpr std::uint64_t kMaxLidars = 16;
constexpr std::uint64_t kMaxText = 1U << 20U;  // bytes of a name, message or remark
static_assert(sizeof(Point) == 3 * sizeof(float), "points lie as they are written");

void put(std::string& out, std::uint64_t number) {
  char bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  out.append(bytes, sizeof number);
}

void put(std::string& out, std::string_view text) {
  put(out, std::uint64_t{text.size()});
  out.append(text);
}

bool is_map_point(const Point& point) {
  return (point.array().abs() <= kMaxMapCoordinate).all();  // false for NaN
}

/// Takes numbers and texts off the front of bytes. After the first that is not there all others are 0 or
/// empty, and ok() is false.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : rest_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

  std::uint64_t number(std::uint64_t most) {
    std::uint64_t value = 0;
    if (rest_.size() < sizeof value) {
      return fail();
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value <= most ? value : fail();
  }

  /// Only of points that a map may have.
  Cloud cloud() {
    const std::uint64_t points = number(kMaxMapPoints);
    if (points > rest_.size() / sizeof(Point)) {
      fail();
      return {};
    }
    Cloud cloud(points);
    std::memcpy(static_cast<void*>(cloud.data()), rest_.data(), points * sizeof(Point));
    rest_.remove_prefix(points * sizeof(Point));
    if (!std::all_of(cloud.begin(), cloud.end(), is_map_point)) {
      fail();
    }
    return cloud;
  }

  std::string text(std::uint64_t longest) {
    const std::uint64_t length = number(longest);
    if (length > rest_.size()) {
      fail();
      return {};
    }
    std::string value(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return value;
  }

 private:
  std::uint64_t fail() {
    ok_ = false;
    rest_ = {};
    return 0;
  }

  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace

void write_prepared_files(int fd, const PreparedFiles& files) {
  std::string head(kMagic);
  put(head, std::uint64_t{files.problems.size()});
  for (const Problem& problem : files.problems) {
    put(head, problem.file);
    put(head, static_cast<std::uint64_t>(problem.line));
    put(head, problem.message);
  }
  put(head, std::uint64_t{files.calibrations.size()});
  for (const std::string& calibration : files.calibrations) {
    put(head, calibration);
  }
  put(head, files.map_remark);
  write_all(fd, head);
  for (const Cloud* cloud : {&files.map_H, &files.quay_W}) {
    std::string count;
    put(count, std::uint64_t{cloud->size()});
    write_all(fd, count);
    write_all(fd, {reinterpret_cast<const char*>(cloud->data()), cloud->size() * sizeof(Point)});
  }
}

Result<PreparedFiles> parse_prepared_files(std::string_view bytes) {
  const Error damaged{"what was read did not arrive whole; try again"};
  if (!bytes.starts_with(kMagic)) {
    return damaged;
  }
  Taker taker(bytes.substr(kMagic.size()));
  PreparedFiles files;
  for (std::uint64_t left = taker.number(kMaxProblems); left > 0 && taker.ok(); --left) {
    Problem problem{.file = taker.text(kMaxText),
                    .line = static_cast<int>(taker.number(kMaxText)),
                    .message = taker.text(kMaxText)};
    files.problems.push_back(std::move(problem));
  }
  for (std::uint64_t left = taker.number(kMaxLidars); left > 0 && taker.ok(); --left) {
    files.calibrations.push_back(taker.text(kMaxCalibration));
  }
  files.map_remark = taker.text(kMaxText);
  files.map_H = taker.cloud();
  files.quay_W = taker.cloud();
  if (!taker.ok() || !taker.rest().empty() || files.map_H.empty() == files.problems.empty()) {
    return damaged;
  }
  return files;
}

}  // namespace hulltrack
