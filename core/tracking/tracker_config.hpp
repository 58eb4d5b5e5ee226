// Settings of the tracker: [hull], [quay], [tracking], [health] of the configuration (ICD 5) as plain values.
#pragma once

#include <optional>

#include "core/base/time.hpp"
#include "core/localisation/hull_config.hpp"
#include "core/quay/quay_config.hpp"
#include "core/registration/registration_config.hpp"
#include "core/sight/metrics.hpp"

namespace hulltrack {

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
