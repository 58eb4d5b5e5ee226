// Where somebody asks the service to read its files again and is told what came of it.
//
// A socket in RuntimeDirectory= of the unit: whoever connects has asked, and is answered when the reload that
// began after that is over. Several may wait at once. ask_for_reload() is the other side, for
// `hulltrackd --reload`, which `systemctl reload` runs.
// Thread rule: the main thread; never waits. Failure: the constructor throws std::system_error; somebody who
// has gone meanwhile is not answered.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/time.hpp"

namespace hulltrack {

class ReloadDesk {
 public:
  /// Without a folder nobody can ask.
  explicit ReloadDesk(const std::optional<std::filesystem::path>& folder);
  ~ReloadDesk();
  ReloadDesk(const ReloadDesk&) = delete;
  ReloadDesk& operator=(const ReloadDesk&) = delete;

  /// Readable when somebody asks; -1 if nobody can.
  [[nodiscard]] int fd() const { return listener_; }
  /// True if somebody has asked since the last call.
  bool take_requests();
  /// Tells everybody who waits. `text`: one line or more.
  void answer(bool reloaded, const std::string& text);

 private:
  int listener_ = -1;
  std::vector<int> waiting_;
};

struct ReloadAnswer {
  bool reloaded = false;
  std::string text;  // what the service says, or why it could not be asked
};

/// Asks the service whose folder this is and waits for the answer, at most for `patience`.
[[nodiscard]] ReloadAnswer ask_for_reload(const std::filesystem::path& folder, Nanoseconds patience);

}  // namespace hulltrack
