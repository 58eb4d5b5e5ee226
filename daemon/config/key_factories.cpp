#include "daemon/config/key_factories.hpp"

namespace hulltrack::keys {
namespace {

constexpr double kMaxLever = 1000.0;  // m: longer than any loader

Numbers box_numbers(const Box& box) {
  Numbers numbers;
  for (const Point& corner : {box.min, box.max}) {
    for (const float value : corner) {
      numbers.push_back(shortest_double(value));
    }
  }
  return numbers;
}

Box box_of(const Numbers& n) {
  return {Eigen::Vector3d(n[0], n[1], n[2]).cast<float>(), Eigen::Vector3d(n[3], n[4], n[5]).cast<float>()};
}

}  // namespace

std::vector<Key> pose(Pose& member) {
  return {
      vector3(
          "xyz", kMaxLever, "m", [&member] { return Eigen::Vector3d(member.translation()); },
          [&member](const Eigen::Vector3d& xyz) { member.translation() = xyz; }),
      vector3(
          "rpy_deg", 360.0, "deg",
          [&member] { return Eigen::Vector3d(rpy_from_rotation(member.linear()).unaryExpr(&tidy_degrees)); },
          [&member](const Eigen::Vector3d& rpy) {
            member.linear() = rotation_from_rpy(rpy * radians(1.0));
          })};
}

bool is_box(const Numbers& n) {
  constexpr double kMax = 10'000.0;  // m
  if (n.size() != 6 || std::any_of(n.begin(), n.end(), [](double v) { return std::abs(v) > kMax; })) {
    return false;
  }
  return n[0] <= n[3] && n[1] <= n[4] && n[2] <= n[5];
}

Key box(std::string name, Box& member) {
  return {.name = std::move(name),
          .allowed = kBoxAllowed,
          .legal = [](const ConfigValue& value) { return is_box(std::get<Numbers>(value)); },
          .get = [&member] { return box_numbers(member); },
          .set = [&member](const ConfigValue& value) { member = box_of(std::get<Numbers>(value)); }};
}

Key optional_number(std::string name, std::optional<double>& member, double min, double max,
                    const char* unit) {
  return {.name = std::move(name),
          .allowed = "a number from " + number_text(min) + " to " + number_text(max) + " (" + unit +
                     "), or 0 for none",
          .legal =
              [=](const ConfigValue& value) {
                const double given = std::get<double>(value);
                return given == 0.0 || (given >= min && given <= max);
              },
          .get = [&member] { return member.value_or(0.0); },
          .set =
              [&member](const ConfigValue& value) {
                const double given = std::get<double>(value);
                member = given == 0.0 ? std::nullopt : std::optional(given);
              }};
}

Key optional_box(std::string name, std::optional<Box>& member) {
  return {.name = std::move(name),
          .allowed = std::string(kBoxAllowed) + ", or [] for none",
          .legal =
              [](const ConfigValue& value) {
                const auto& numbers = std::get<Numbers>(value);
                return numbers.empty() || is_box(numbers);
              },
          .get = [&member] { return member ? box_numbers(*member) : Numbers{}; },
          .set =
              [&member](const ConfigValue& value) {
                const auto& numbers = std::get<Numbers>(value);
                member = numbers.empty() ? std::nullopt : std::optional(box_of(numbers));
              }};
}

Key boxes(std::string name, std::vector<std::array<double, 6>>& member, std::size_t most) {
  return {.name = std::move(name),
          .allowed = "a list of at most " + std::to_string(most) + " boxes, each " + kBoxAllowed,
          .legal =
              [most](const ConfigValue& value) {
                const auto& lists = std::get<std::vector<Numbers>>(value);
                return lists.size() <= most && std::all_of(lists.begin(), lists.end(), is_box);
              },
          .get =
              [&member] {
                std::vector<Numbers> lists;
                for (const auto& numbers : member) {
                  lists.emplace_back(numbers.begin(), numbers.end());
                }
                return lists;
              },
          .set =
              [&member](const ConfigValue& value) {
                member.clear();
                for (const Numbers& numbers : std::get<std::vector<Numbers>>(value)) {
                  std::copy_n(numbers.begin(), 6, member.emplace_back().begin());
                }
              }};
}

}  // namespace hulltrack::keys
