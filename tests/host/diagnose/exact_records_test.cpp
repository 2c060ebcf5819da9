// Draws of exact machines beside the records that they are like: the demonstration's machine, with the forces of its
// guide and a noise of its current's sensor that is seven times as strong.
#include "host/diagnose/exact_records.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "host/diagnose/prepare.hpp"
#include "host/diagnose/record/encoder_noise.hpp"
#include "host/simulate/commissioning.hpp"
#include "sim/machine_file.hpp"

namespace stiction::test {
namespace {

constexpr double force_constant = 94.2;  // N/A
constexpr double guide = 3.2;            // N rms: 2.5 below 3 Hz and 2 below 40 Hz

class ExactRecords : public testing::Test {
 protected:
  // With white noise of the current, A rms, and one of the encoder, m rms, of which the file says 2 nm.
  void prepare_with(double noise, double of_encoder = 2e-9) {
    input_.machine = sim::read_machine(
        std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
        {{},
         {"axis.X.encoder.velocity=estimated", "axis.X.encoder.noise=2 nm", "axis.X.motor.force_constant=94.2 N/A"}});
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0.0, noise);
    auto machine = input_.machine;
    machine.axes.front().encoder.noise = of_encoder;
    for (auto& record : host::record_commissioning(machine, 0, 1)) {
      for (double& i : record.log.axes.front().i) i += normal(random);
      (record.held_out ? input_.held_out : input_.logs).push_back(std::move(record.log));
    }
    host::Verdict verdict;
    prepared_ = host::prepare(input_, host::RowBand::usual, verdict);
  }
  double deviation(const Eigen::VectorXd& force) const {
    return std::sqrt(force.squaredNorm() / prepared_->training.regressors.counts().sum());
  }

  host::DiagnoseInput input_;
  std::unique_ptr<host::Prepared> prepared_;
};

// What an encoder of its own noise and increments leaves is in both.
TEST_F(ExactRecords, AreUnderTheForcesThatMovedTheAxis) {
  constexpr double noise = 0.25;  // A
  prepare_with(noise);
  const auto& target = prepared_->training.target;
  const auto parts = prepared_->on_axis.parts_of(target);
  EXPECT_NEAR(deviation(parts.on_axis), guide, 0.3 * guide);
  // Of 500 Hz the rows have 100.
  const double seen = noise * force_constant * std::sqrt(0.2);
  EXPECT_NEAR(deviation(parts.in_record), seen, 0.2 * seen);
  const auto draws = prepared_->context.exact_records(target)(0, 4);
  ASSERT_EQ(draws.size(), 4U);
  for (const auto& draw : draws) EXPECT_NEAR(deviation(draw.target), deviation(target), 0.25 * deviation(target));
}

// The file knows of little: they have as much as the record, another one in each draw.
TEST_F(ExactRecords, HaveTheNoiseOfTheRecordsEncoder) {
  constexpr double of_encoder = 60e-9;
  prepare_with(0.0, of_encoder);
  const auto& training = prepared_->training;
  const auto found = host::encoder_noise(training.logs, training.simulated, prepared_->axis);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, of_encoder, 0.05 * of_encoder);
  const auto draws = prepared_->context.exact_records(Eigen::VectorXd::Zero(training.target.size()))(0, 2);
  ASSERT_EQ(draws.size(), 2U);
  const double shared = draws[0].target.dot(draws[1].target) / (draws[0].target.norm() * draws[1].target.norm());
  EXPECT_GT(deviation(draws[0].target), 0.0);
  EXPECT_LT(shared, 0.5);
}

TEST_F(ExactRecords, HaveReadWhereTheyWere) {
  prepare_with(0.0);
  const auto draws = prepared_->context.exact_records(prepared_->training.target)(0, 2);
  ASSERT_EQ(draws.size(), 2U);
  ASSERT_EQ(draws[0].read.size(), input_.logs.size());
  double square = 0.0;
  for (std::size_t i = 0; i < draws[0].read[0].size(); ++i)
    square += std::pow(draws[0].read[0][i] - draws[1].read[0][i], 2) / static_cast<double>(draws[0].read[0].size());
  EXPECT_GT(std::sqrt(square), 5e-9);  // m: more than the encoder's noise alone
}

}  // namespace
}  // namespace stiction::test
