// What of a residual force acted on an axis, told by how it moved. The axis is a low-pass of first order, the forces
// are autoregressions, both of textbooks.
#include "host/diagnose/record/force_on_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/diagnose/record/redrawn_residual.hpp"
#include "host/diagnose/statistics/octaves.hpp"

namespace stiction::test {
namespace {

using host::ForceOnAxis;
using host::Octaves;
using host::RedrawnResidual;

constexpr Eigen::Index rows = 8000;
constexpr double period = 4e-3;  // s
const std::vector<std::size_t> two_logs{0, 3000};

// N, of this deviation, in which each row keeps `kept` of the one before.
Eigen::VectorXd wandering(double deviation, double kept, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, deviation * std::sqrt(1.0 - kept * kept));
  Eigen::VectorXd force(rows);
  double value = 0.0;
  for (double& f : force) f = value = kept * value + normal(random);
  return force;
}

// m/s: 200 kg that a loop brings back with a time constant of 40 ms.
Eigen::VectorXd speed_under(const Eigen::VectorXd& force) {
  Eigen::VectorXd speed(force.size());
  double v = 0.0;
  for (Eigen::Index i = 0; i < force.size(); ++i)
    speed[i] = v = v * std::exp(-period / 0.04) + period / 200.0 * force[i];
  return speed;
}

Eigen::VectorXd time_of_rows() {
  Eigen::VectorXd time(rows);
  for (Eigen::Index i = 0; i < rows; ++i) time[i] = period * static_cast<double>(i < 3000 ? i : i - 3000);
  return time;
}

// Draws of a machine that moves as above and leaves the force and `own_force`, N, by itself.
std::vector<ForceOnAxis::Answer> answers_to(const Eigen::VectorXd& force, double own_force) {
  const RedrawnResidual redrawn(force, two_logs, time_of_rows(), period);
  const Eigen::VectorXd time = time_of_rows();
  std::vector<ForceOnAxis::Answer> answers;
  for (std::uint64_t draw = 0; draw < 4; ++draw) {
    Eigen::VectorXd drawn(rows);
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Index begin = k == 0 ? 0 : 3000, length = k == 0 ? 3000 : rows - 3000;
      const auto part = redrawn.drawn(k, {time.data() + begin, static_cast<std::size_t>(length)}, 2 * draw + k);
      drawn.segment(begin, length) = Eigen::Map<const Eigen::VectorXd>(part.data(), length);
    }
    answers.push_back({speed_under(drawn), drawn + wandering(own_force, 0.0, 90 + draw)});
  }
  return answers;
}

double deviation(const Eigen::VectorXd& force) { return std::sqrt(force.squaredNorm() / rows); }

TEST(ForceOnAxis, IsAllBeforeTheAxisWasAsked) {
  const auto force = wandering(2.0, 0.9, 1);
  EXPECT_EQ(ForceOnAxis().parts_of(force).on_axis, force);
  EXPECT_EQ(ForceOnAxis().parts_of(force).in_record.size(), 0);
}

// 2 N that move the axis and 3 N of a current's sensor.
TEST(ForceOnAxis, IsWhatMovesTheAxisAndTheRestIsInTheRecord) {
  const Eigen::VectorXd acted = wandering(2.0, 0.9, 1), residual = acted + wandering(3.0, 0.0, 2);
  ForceOnAxis force(residual, speed_under(acted), two_logs);
  force.take_answers(answers_to(force.parts_of(residual).on_axis, 0.0));
  // Of the lowest octave 20 lines are known to a quarter.
  EXPECT_NEAR(deviation(force.parts_of(residual).on_axis), 2.0, 0.15);
  force.take_remainders(answers_to(force.parts_of(residual).on_axis, 0.0));
  EXPECT_NEAR(deviation(force.parts_of(residual).in_record), 3.0, 0.15);
  // Where causes have taken most of the residual there is no more than what they left.
  const auto parts = force.parts_of(0.1 * residual);
  EXPECT_LE(deviation(parts.on_axis), 0.1 * deviation(residual) + 1e-12);
}

// What exact machines leave by themselves is no sensor's.
TEST(ForceOnAxis, LeavesToAnAxisInALimitCycleWhatItDoesByItself) {
  const Eigen::VectorXd acted = wandering(0.5, 0.9, 1), residual = acted + wandering(3.0, 0.0, 2);
  ForceOnAxis force(residual, speed_under(acted), two_logs);
  force.take_answers(answers_to(force.parts_of(residual).on_axis, 3.0));
  EXPECT_NEAR(deviation(force.parts_of(residual).on_axis), 0.5, 0.05);
  force.take_remainders(answers_to(force.parts_of(residual).on_axis, 3.0));
  EXPECT_LT(deviation(force.parts_of(residual).in_record), 0.6);
}

TEST(ForceOnAxis, GivesNothingWhereNothingCounts) {
  Eigen::VectorXd residual = wandering(2.0, 0.9, 1);
  residual.segment(500, 1000).setZero();
  ForceOnAxis force(residual, 0.1 * speed_under(residual), two_logs);
  force.take_answers(answers_to(residual, 0.0));
  EXPECT_TRUE(force.parts_of(residual).on_axis.segment(500, 1000).isZero());
}

TEST(Octaves, HoldTheSquareOfTheRowsAndEachItsOwn) {
  const auto force = wandering(2.0, 0.9, 6);
  const Octaves octaves(two_logs, rows);
  double sum = 0.0;
  for (const double power : octaves.of(force)) sum += power;
  EXPECT_NEAR(sum, force.squaredNorm(), 1e-9 * force.squaredNorm());
  // A tenth of the rows' rate lies in the third octave below half of it.
  Eigen::VectorXd wave(rows);
  for (Eigen::Index i = 0; i < rows; ++i) wave[i] = std::sin(2.0 * std::numbers::pi * 0.1 * static_cast<double>(i));
  const auto of_wave = octaves.of(wave);
  EXPECT_GT(of_wave[2], 0.99 * wave.squaredNorm());
  Octaves::Powers gains(octaves.count(), 1.0);
  gains[2] = 0.0;
  EXPECT_LT(octaves.scaled(wave, gains).squaredNorm(), 0.01 * wave.squaredNorm());
}

// A number of rows that is prime, and so long that it has zeros behind it.
TEST(Octaves, HoldALongLogOfAnyLength) {
  constexpr Eigen::Index prime = 19997;
  const Eigen::VectorXd force = wandering(2.0, 0.9, 7).replicate(3, 1).topRows(prime);
  const std::vector<std::size_t> one_log{0};
  const Octaves octaves(one_log, prime);
  double sum = 0.0;
  for (const double power : octaves.of(force)) sum += power;
  EXPECT_NEAR(sum, force.squaredNorm(), 1e-9 * force.squaredNorm());
  const Octaves::Powers gains(octaves.count(), 0.5);
  EXPECT_LT((octaves.scaled(force, gains) - 0.5 * force).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace stiction::test
