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
  // Limits of the ratio of Q1 to its expected value at the pose. If a share h of what should be in view is
  // not there, the ratio grows. A sensor with lines of rays: by 1 / (1 - h), since distances to the nearest
  // ray are spread evenly. One with scattered rays: by sqrt(ln(1 - 0.25 / (1 - h)) / ln(0.75)).
  double q1_ratio_healthy = 1.5;  // at or below = tracking: h up to 0.33 (lines) or 0.47 (scattered)
  double q1_ratio_lost = 3.0;     // above = lost: h above 0.67 (lines) or 0.73 (scattered)
  // Limits of Q1 itself, in addition, where a site knows its sensor and its distances:
  std::optional<double> q1_healthy;  // m: at or below = tracking
  std::optional<double> q1_lost;     // m: above = lost
  double metric_range = 25.0;        // m from the sensor: Q1 is taken over nearer map points
  int min_matched = 200;             // matched points; fewer = lost
  int recover_frames = 5;            // good frames in a row before health returns
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
