// A start with parameters that are damaged, or that would refuse it: the set before them, and the axes stay off.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "firmware/stictiond/configuration.hpp"
#include "firmware/stictiond/programme.hpp"
#include "hal/simulated/simulated_backend.hpp"

namespace stiction::test {
namespace {

using drive::ParameterSet;

class StoredStart : public ::testing::Test {
 protected:
  StoredStart() : folder_(std::filesystem::temp_directory_path() / ("stiction-start-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    options_.machine = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";
    options_.parameters = folder_.string();
  }
  ~StoredStart() override { std::filesystem::remove_all(folder_); }

  void store(const std::string& key, double value) {
    drive::write_parameters(file(), ParameterSet{"mcfv5050ln", {{key, value}}});
  }
  std::filesystem::path file() const { return drive::parameter_file(options_); }

  std::filesystem::path folder_;
  drive::DriveOptions options_;
};

const std::string stored_gain = "axis.X.velocity_controller.gain";

TEST_F(StoredStart, TakesWhatIsStored) {
  EXPECT_FALSE(drive::read_configuration(options_).stored);
  store(stored_gain, 550.0);
  const auto c = drive::read_configuration(options_);
  EXPECT_FALSE(c.rejected_parameters);
  EXPECT_EQ(c.machine.axes[0].velocity_controller.gain, 550.0);
}

TEST_F(StoredStart, FallsBackToTheSetBeforeWhereTheStoredOneIsDamagedOrWouldRefuseIt) {
  struct Row {
    const char* key;
    double value;
    const char* said;
  };
  for (const auto& row :
       {Row{"axis.X.supervision.over_speed", 9.0, "over_speed"},
        Row{"drive.axis.X.quick_stop_deceleration", 1e-6, "quick_stop_deceleration"},
        Row{"drive.axis.X.negative_end", 0.4, "positive_end"}, Row{"axis.X.notch.frequency", 9000.0, "notch"}}) {
    SCOPED_TRACE(row.key);
    store(stored_gain, 550.0);
    store(row.key, row.value);
    const auto c = drive::read_configuration(options_);
    ASSERT_TRUE(c.rejected_parameters);
    EXPECT_NE(c.rejected_parameters->find(row.said), std::string::npos) << *c.rejected_parameters;
    EXPECT_EQ(c.machine.axes[0].velocity_controller.gain, 550.0);
    ASSERT_TRUE(c.stored);
    EXPECT_EQ(c.stored->values.at(stored_gain), 550.0);
  }
  store(stored_gain, 550.0);
  store(stored_gain, 560.0);
  std::ofstream(file(), std::ios::app) << "x";
  const auto c = drive::read_configuration(options_);
  ASSERT_TRUE(c.rejected_parameters);
  EXPECT_EQ(c.machine.axes[0].velocity_controller.gain, 550.0);
}

TEST_F(StoredStart, FallsBackToTheMachineFileWhereNoSetCanBeUsed) {
  store("axis.X.notch.frequency", 9000.0);
  auto c = drive::read_configuration(options_);
  EXPECT_TRUE(c.rejected_parameters);
  EXPECT_FALSE(c.stored);
  EXPECT_EQ(c.machine.axes[0].velocity_controller.gain, 600.0);
  store("axis.X.notch.frequency", 9500.0);
  c = drive::read_configuration(options_);
  EXPECT_TRUE(c.rejected_parameters);
  EXPECT_FALSE(c.stored);
}

TEST_F(StoredStart, IsRefusedWhereTheMachineFileItselfIsWrong) {
  store(stored_gain, 550.0);
  options_.set = {"axis.X.notch.frequency=9000 Hz"};
  EXPECT_THROW(drive::read_configuration(options_), std::exception);
}

// Fault 50 from the first tick to the end, whatever is asked for.
TEST_F(StoredStart, KeepsTheAxesOffAfterwards) {
  store("axis.X.notch.frequency", 9000.0);
  const auto c = drive::read_configuration(options_);
  using Simulated = hal::SimulatedBackend<FixedSignals>;
  Simulated simulated(c.machine, std::vector<double>{0.0, 0.0});
  hal::DriveLoop<Simulated> loop(simulated, c.axes, c.drives, c.ticker, c.compensations);
  const auto log = std::make_unique<drive::LogRing>();
  const drive::Task task{.approach = drive::Motion(2), .motion = drive::Motion(2), .idle_ticks = 0, .serve = true};
  const std::vector<RemoteAxisConfig> remote(2);
  drive::Programme<Simulated> programme(loop, task, remote, *log, nullptr);
  programme.keep_off(Fault::parameters_damaged);
  for (int i = 0; i < 2000; ++i) {
    const auto word = controlword_to_enable(loop.state(0), i % 7 == 0);
    for (auto& axis : programme.remote()) axis.ask(word);
    programme.tick(false);
    ASSERT_FALSE(loop.drive(0).powered() || loop.drive(1).powered());
  }
  EXPECT_EQ(loop.fault(0), Fault::parameters_damaged);
  EXPECT_EQ(loop.fault(1), Fault::parameters_damaged);
}

}  // namespace
}  // namespace stiction::test
