#include "daemon/pipeline/load_map.hpp"

#include <string>
#include <utility>

#include "core/base/text.hpp"
#include "core/io/map_file.hpp"
#include "core/map/stray_points.hpp"

namespace hulltrack {
namespace {

std::string about(const std::filesystem::path& file, const StrayPoints& strays, std::size_t all) {
  return file.string() +
         format_text(
             ": %zu of its %s lie %.0f to %.0f m from all others and were left out; if they are stray "
             "returns, delete them there, and if they are ship, map what is between",
             strays.count, counted(all, "point").c_str(), strays.nearest, strays.farthest);
}

}  // namespace

LoadedMap load_map(const std::filesystem::path& file, const TrackerConfig& config,
                   const std::function<void()>& building) {
  LoadedMap loaded;
  Result<MapFile> read = read_map_file(file);
  if (!read) {
    loaded.findings.push_back({true, "hull.map", read.error().message});
    return loaded;
  }
  for (std::string& remark : remarks_on(file, *read)) {
    loaded.findings.push_back({false, "hull.map", std::move(remark)});
  }
  const auto judged = [&](std::vector<MapFinding> findings) {
    for (MapFinding& finding : findings) {
      finding.message = (finding.key == "hull.map" ? file.string() + ": " : "") + finding.message;
      loaded.findings.push_back(std::move(finding));
    }
  };
  Cloud cloud = std::move(read->cloud);
  const std::size_t all = cloud.size();
  if (const StrayPoints strays = take_out_strays(cloud); strays.count > 0) {
    loaded.findings.push_back({false, "hull.map", about(file, strays, all)});
  }
  judged(judge_cloud(cloud, config));
  if (!is_refused(loaded.findings)) {
    if (building) {
      building();
    }
    auto map = std::make_shared<const HullMap>(std::move(cloud));
    judged(judge_map(*map));
    if (!is_refused(loaded.findings)) {
      loaded.map = std::move(map);
    }
  }
  return loaded;
}

}  // namespace hulltrack
