// The main of `hulltrack`, the tool beside the service: picks the subcommand and turns failures into
// one line and an exit code (0 done, 1 it failed, 2 wrong command line).
#include <cstdio>
#include <exception>
#include <string>

#include "daemon/tools/tools.hpp"

namespace hulltrack {
namespace {

/// "hulltrack", or "hulltrack decode" once a subcommand has been recognised.
std::string program_name(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "hulltrack" : "hulltrack " + chosen.front()->get_name();
}

void add_subcommands(CLI::App& app) {
  add_decode(app);
  add_models(app);
  add_probe(app);
  add_replay(app);
  add_simulate(app);
  app.require_subcommand(1);
}

/// A first word that is neither option nor subcommand; CLI11 would only say that one is missing.
void check_subcommand(CLI::App& app, const std::string& word) {
  std::string known;
  for (const CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (subcommand->get_name() == word) {
      return;
    }
    known += (known.empty() ? "" : ", ") + subcommand->get_name();
  }
  if (!word.starts_with('-')) {
    throw ToolError(kExitUsage, "there is no subcommand \"" + word + "\"; there are " + known);
  }
}

int run(int argc, char** argv) {
  CLI::App app{"Tools around hulltrackd, the service that tracks a moored ship's hull for a ship loader."};
  app.name("hulltrack");
  app.set_version_flag("--version", "hulltrack " HULLTRACK_VERSION);
  app.footer("Each subcommand explains itself: hulltrack SUBCOMMAND --help. Manual: hulltrack(1).");
  add_subcommands(app);
  try {
    if (argc > 1) {
      check_subcommand(app, argv[1]);
    }
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& wrong) {
    const std::string name = program_name(app);
    std::fprintf(stderr, "%s: %s\nTry: %s --help\n", name.c_str(), wrong.what(), name.c_str());
    return kExitUsage;
  } catch (const ToolError& failure) {
    std::fprintf(stderr, "%s: %s\n", program_name(app).c_str(), failure.what());
    return failure.exit_code();
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s: %s\n", program_name(app).c_str(), failure.what());
    return kExitFailed;
  }
}

}  // namespace
}  // namespace hulltrack

int main(int argc, char** argv) { return hulltrack::run(argc, argv); }
