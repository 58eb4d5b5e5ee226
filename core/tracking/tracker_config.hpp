// Settings of the tracker: [hull], [tracking], [health] of the configuration (ICD 5) as plain values.
#pragma once

#include <optional>

#include "core/base/time.hpp"
#include "core/geometry/box.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

struct HullConfig {
  Eigen::Vector3d reference_point = Eigen::Vector3d::Zero();    // in H, m
  std::optional<Box> region;                                    // in W; empty = no crop
  Box envelope{{-15.0F, -2.0F, -10.0F}, {15.0F, 2.0F, 10.0F}};  // displacements a berthed ship can have, m
  double max_speed = 0.3;                                       // m/s
  // A moored ship lists by 1 deg, by 3 where her pilot is called, trims by 1 to 3 m over her length and is
  // held in line with the quay by her lines: beyond these, rad, the pose is not hers.
  double max_heel = radians(4.0);
  double max_trim = radians(2.0);
  double max_yaw = radians(3.5);
};

/// What is known of the quay besides its map, which is a file (ICD 5).
struct QuayConfig {
  bool top_is_witness = true;            // false: height = "off"
  std::optional<double> height;          // of its top at W's origin, m; empty = learn
  std::optional<Eigen::Vector2d> slope;  // of its top along X and along Y, rad; empty = learn
};

enum class RegistrationMethod {
  automatic,       // this version's best
  point_to_point,  // the paper, 2.3
};

/// Defaults: the paper's parameters (Guo 2025, 2.3).
struct RegistrationConfig {
  double voxel_size = 0.5;                   // m
  double max_correspondence_distance = 0.3;  // m
  int max_iterations = 50;
  double translation_epsilon = 0.001;      // m
  double rotation_epsilon = radians(0.1);  // rad
  RegistrationMethod method = RegistrationMethod::automatic;
};

/// Which map points the metrics are taken over (ICD 3).
enum class MetricsScope {
  visible_subset,  // live: visible points of the fixed 0.4 m subset
  visible_full,    // every visible point
  whole_map,       // the paper's literal definition: every map point, seen or not; no Q1 is expected
};

struct HealthConfig {
  // Q1 over what it should be at the pose. The distance to the nearest ray of a pattern of lines is spread
  // evenly, so with a share h of what should be in view not there Q1 grows by 1 / (1 - h); between scattered
  // rays by sqrt(ln(1 - 0.25 / (1 - h)) / ln(0.75)).
  double q1_ratio_healthy = 1.5;  // at or below = tracking: h of 0.33 to 0.47
  double q1_ratio_lost = 3.0;     // above = lost: h of 0.67 to 0.73
  // Besides, where a site knows its sensor and its distances:
  std::optional<double> q1_healthy;  // m: at or below = tracking
  std::optional<double> q1_lost;     // m: above = lost
  double metric_range = 25.0;        // m from the sensor
  int min_matched = 200;
  int recover_frames = 5;  // good frames in a row before health returns
  Nanoseconds max_age = std::chrono::milliseconds(500);
};

struct TrackerConfig {
  HullConfig hull;
  QuayConfig quay;
  RegistrationConfig registration;
  HealthConfig health;
  MetricsScope metrics_scope = MetricsScope::visible_subset;
};

}  // namespace hulltrack
