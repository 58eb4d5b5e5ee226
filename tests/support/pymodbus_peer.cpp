#include "tests/support/pymodbus_peer.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <stdexcept>

namespace hulltrack {
namespace {

constexpr const char* kPython = "/usr/bin/python3";  // Debian's: the one that has python3-pymodbus
constexpr const char* kScript = HULLTRACK_SOURCE_DIR "/tests/support/pymodbus_plc.py";

}  // namespace

PymodbusPeer::PymodbusPeer(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {kPython, kScript, "--log", "-"});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  int in[2], out[2];
  if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe for pymodbus_plc.py");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  const int rc = posix_spawn(&pid_, kPython, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(in[0]);
  close(out[1]);
  to_child_ = in[1];
  from_child_ = out[0];
  if (rc != 0) {
    pid_ = -1;
    return;
  }
  const std::string line = read_line();
  if (line.starts_with("port ")) port_ = static_cast<std::uint16_t>(std::stoi(line.substr(5)));
  if (started()) static_cast<void>(read_line());  // the log's header
}

PymodbusPeer::~PymodbusPeer() {
  close(to_child_);
  close(from_child_);
  if (pid_ > 0) waitpid(pid_, nullptr, 0);
}

void PymodbusPeer::send_line(const std::string& line) {
  const std::string bytes = line + "\n";
  if (write(to_child_, bytes.data(), bytes.size()) < 0) throw std::runtime_error("pymodbus_plc.py has ended");
}

std::string PymodbusPeer::read_line() {
  for (;;) {
    if (const auto end = buffered_.find('\n'); end != std::string::npos) {
      std::string line = buffered_.substr(0, end);
      buffered_.erase(0, end + 1);
      return line;
    }
    char chunk[4096];
    const ssize_t got = read(from_child_, chunk, sizeof chunk);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return {};
    buffered_.append(chunk, static_cast<std::size_t>(got));
  }
}

}  // namespace hulltrack
