#include "daemon/pipeline/quay_file.hpp"

#include <utility>

#include "core/base/text.hpp"
#include "core/io/map_file.hpp"

namespace hulltrack {
namespace {

// A scan meets some of them only; fewer than this in all and it hardly ever meets the ten that hold a
// direction (plane_system.hpp).
constexpr std::size_t kFewest = 100;

std::string unseen_joints(const QuayMap& map) {
  std::string unseen;
  const auto add = [&](SurfaceClass surface, const char* what, const char* joints) {
    if (map.count(surface) < kFewest) {
      unseen += unseen.empty() ? "" : "; ";
      unseen += "has " + counted(map.count(surface), "flat piece") + " " + what + ", so " + joints;
    }
  };
  add(SurfaceClass::transverse, "across the rails", "it hardly shows a wrong travel");
  add(SurfaceClass::longitudinal, "along the rails", "it hardly shows a wrong slew or mount");
  add(SurfaceClass::horizontal, "that lie level", "it hardly shows a wrong luff or mount");
  return unseen;
}

}  // namespace

Result<QuayFile> read_quay_file(const std::filesystem::path& file) {
  if (file.empty()) {
    return QuayFile{};
  }
  Result<MapFile> read = read_map_file(file);
  if (!read) {
    return read.error();
  }
  QuayFile quay;
  for (const std::string& line : remarks_on(file, *read)) {
    quay.remark += (quay.remark.empty() ? "" : "\n") + line;
  }
  quay.cloud_W = std::move(read->cloud);
  quay.map = std::make_shared<const QuayMap>(quay.cloud_W);
  if (quay.map->planes().size() < kFewest) {
    return Error{
        file.string() + ": has " + counted(quay.map->planes().size(), "flat piece") + " in " +
        counted(quay.cloud_W.size(), "point") + ", " + std::to_string(kFewest) +
        " are needed: survey the quay without a ship, metres, at least 8 points within 0.3 m of each "
        "other"};
  }
  if (const std::string unseen = unseen_joints(*quay.map); !unseen.empty()) {
    quay.remark += (quay.remark.empty() ? "" : "\n") + file.string() + ": " + unseen +
                   "; walls, trestles and sheds in the map would";
  }
  return quay;
}

}  // namespace hulltrack
