// The subcommands of `hulltrack`: one file each in this folder, one add_ function each.
//
// add_xxx registers its subcommand on the app: options, a help text with an example, and a callback
// that does the job. A job that fails throws ToolError; main prints it as one line,
// "hulltrack xxx: message", and exits with its code. Results go to files or standard output,
// progress and summaries to standard error.
#pragma once

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string>

namespace hulltrack {

/// Exit codes of every program here; see hulltrack(1).
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;

class ToolError : public std::runtime_error {
 public:
  /// `message`: one line, what failed and what to do about it.
  ToolError(int exit_code, const std::string& message) : std::runtime_error(message), exit_code_(exit_code) {}
  explicit ToolError(const std::string& message) : ToolError(kExitFailed, message) {}
  [[nodiscard]] int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

void add_decode(CLI::App& app);
void add_models(CLI::App& app);
void add_probe(CLI::App& app);
void add_replay(CLI::App& app);
void add_simulate(CLI::App& app);

}  // namespace hulltrack
