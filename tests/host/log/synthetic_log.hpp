// Logs made up for the tests of their formats.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "host/log/log.hpp"

namespace stiction::test {

// Two axes with a few channels each, ten columns in all, with values whose decimal text is long.
inline host::Log synthetic_log(std::size_t samples) {
  host::Log log;
  log.source = "synthetic";
  log.comments = {{"machine", "none"}, {"made by", "a test"}};
  log.axes.resize(2);
  log.axes[0].axis = "X";
  log.axes[1].axis = "Y";
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = static_cast<double>(k) * 62.5e-6;
    log.t.push_back(t);
    for (auto& axis : log.axes) {
      const double phase = axis.axis == "X" ? 3.0 * t : 3.0 * t + 1.5;
      axis.x_set.push_back(0.09 * std::sin(phase));
      axis.x.push_back(0.09 * std::sin(phase) + 1e-6 * std::cos(40.0 * phase));
      axis.i.push_back(2.3 * std::cos(phase));
      axis.v.push_back(0.27 * std::cos(phase));
    }
    log.axes[0].temperature.push_back(25.0 + t / 3.0);
  }
  log.period = (log.t.back() - log.t.front()) / static_cast<double>(samples - 1);
  return log;
}

}  // namespace stiction::test

namespace stiction::host {

inline void expect_same_log(const Log& a, const Log& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.period, b.period);
  EXPECT_EQ(a.comments, b.comments);
  ASSERT_EQ(a.axes.size(), b.axes.size());
  for (std::size_t k = 0; k < a.axes.size(); ++k) {
    EXPECT_EQ(a.axes[k].axis, b.axes[k].axis);
    for (const auto& channel : log_channels)
      EXPECT_EQ(a.axes[k].*channel.values, b.axes[k].*channel.values) << a.axes[k].axis << "." << channel.name;
  }
}

}  // namespace stiction::host
