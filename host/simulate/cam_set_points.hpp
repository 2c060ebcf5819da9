// Set-points of a cam as the drive makes them: its virtual master, its table, its cam motion, in the drive's integers.
// `stictiond --cam` has the same from the same table, axis and speed, to the last digit.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/cam/motion.hpp"
#include "sim/experiment/set_point.hpp"
#include "stiction/drive/cam_mode.hpp"
#include "stiction/motion/master.hpp"
#include "stiction/motion/master_estimator.hpp"

namespace stiction::host {

// What the slave knows of its master.
enum class MasterSignal {
  ideal,  // the virtual master itself
  noisy,  // a position with noise of master_noise, through the estimator of the firmware
  steps   // the same of an encoder with master_steps in a cycle
};

inline constexpr double master_noise = 1e-5;   // rms, of a cycle
inline constexpr double master_steps = 10000;  // in a cycle

class CamSetPoints {
 public:
  // `timing`, `axis`: of the machine that follows; `motion`: on it, in its own unit; `master_speed`: to which the
  // master goes, its unit over s; `signal`: what the slave sees of it. Throws machine::ConfigurationError where the
  // axis' limits or the formats do not hold the motion, sim::cam::CamError where no table does.
  CamSetPoints(const machine::Timing& timing, const machine::AxisModel& axis, const sim::cam::Motion& motion,
               double master_speed, MasterSignal signal = MasterSignal::ideal);
  CamSetPoints(const CamSetPoints&) = delete;
  CamSetPoints& operator=(const CamSetPoints&) = delete;
  ~CamSetPoints() = default;

  double start() const { return start_; }  // m, where the axis begins
  // A tick on.
  void step();

  const SetPoint<FixedSignals>& set_point() const { return set_; }  // m
  sim::AxisSetPoint in_si() const;                                  // the same, m
  double position() const;                                          // m
  // The true master.
  const MasterPoint& master() const { return true_master_; }
  bool at_speed() const { return master_.at_speed(); }
  double cycles_per_second() const;
  const std::vector<std::uint8_t>& table() const { return bytes_; }

 private:
  MasterReading seen();

  double period_, start_ = 0.0;
  MasterSignal signal_;
  std::vector<std::uint8_t> bytes_;
  CamTable table_;
  CamCurve curve_;
  CamMode::Config config_;
  VirtualMaster master_;
  MasterPoint true_master_{};
  MasterEstimator estimator_;
  std::mt19937_64 engine_{1};
  std::normal_distribution<double> noise_;
  std::unique_ptr<CamMode> axis_;
  SetPoint<FixedSignals> set_{};
};

}  // namespace stiction::host
