// The Modbus client against a power stage that another program plays: pymodbus, and the project's own server.
#include <mutex>

#include "hal/bus_budget.hpp"
#include "hal/modbus/client.hpp"
#include "hal/modbus/modbus_backend.hpp"
#include "tests/hal/modbus_support.hpp"

namespace stiction::test {
namespace {

// A power stage on the project's own server: shows the velocity command as its velocity.
class Stage {
 public:
  explicit Stage(const std::string& address) : server_(hal::power_stage_map(), config_of(address), values()) {}

  int port() const { return server_.port(); }
  hal::PowerStageCommand command() {
    const std::lock_guard lock(mutex_);
    while (const auto write = server_.take_write()) hal::apply(*write, command_);
    return command_;
  }
  void set(const hal::PowerStageState& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
  }
  void freeze() { frozen_ = true; }

 private:
  static hal::ModbusServerConfig config_of(const std::string& address) {
    hal::ModbusServerConfig config;
    config.address = address;
    config.motion_allowed = true;
    return config;
  }
  hal::RegisterValues values() {
    return [this](std::span<double> values) {
      const std::lock_guard lock(mutex_);
      if (!frozen_) ++state_.cycle;
      hal::put_power_stage_values(state_, values);
    };
  }

  std::mutex mutex_;
  hal::PowerStageState state_;
  hal::PowerStageCommand command_;
  std::atomic<bool> frozen_{false};
  hal::ModbusServer server_;
};

// Slow enough for a slave in Python on a busy machine.
hal::ModbusClientConfig config_for(const std::string& device, double period = 0.1) {
  hal::ModbusClientConfig config;
  config.device = device;
  config.period = period;
  return config;
}

std::string local(int port) { return "127.0.0.1:" + std::to_string(port); }

int free_port() {
  const Stage stage("127.0.0.1:0");
  return stage.port();
}

TEST(PowerStage, SurvivesItsOwnRegisters) {
  hal::PowerStageState state;
  state.fault = state.home = state.enabled = true;
  state.cycle = 0xfedc;
  state.position = -1.23456789;
  state.velocity = 0.25;
  state.current = -3.5;
  state.torque_off_b = state.has_dc_link = state.has_stage_temperature = true;
  state.dc_link = 565.7;
  state.motor_temperature = -12.3;
  state.stage_temperature = 87.6;
  const auto& map = hal::power_stage_map();
  std::vector<double> values(map.registers().size());
  hal::put_power_stage_values(state, values);
  std::vector<std::uint16_t> words(map.size(hal::RegisterTable::holding));
  map.encode(values, {}, words);
  EXPECT_EQ(words[0], hal::power_stage_identification);
  const auto found = hal::state_in(std::span(words).first<hal::power_stage_read_words>());
  EXPECT_EQ(found.fault, true);
  EXPECT_EQ(found.limit_negative, false);
  EXPECT_EQ(found.limit_positive, false);
  EXPECT_EQ(found.home, true);
  EXPECT_EQ(found.enabled, true);
  EXPECT_EQ(found.cycle, 0xfedc);
  EXPECT_NEAR(found.position, state.position, 5e-9);  // half a step of the register
  EXPECT_EQ(found.velocity, 0.25);
  EXPECT_EQ(found.current, -3.5);
  EXPECT_FALSE(found.torque_off_a);
  EXPECT_TRUE(found.torque_off_b);
  EXPECT_FALSE(found.has_torque_off);
  EXPECT_TRUE(found.has_dc_link);
  EXPECT_FALSE(found.has_motor_temperature);
  EXPECT_TRUE(found.has_stage_temperature);
  EXPECT_NEAR(found.dc_link, 565.7, 1e-9);
  EXPECT_NEAR(found.motor_temperature, -12.3, 1e-9);
  EXPECT_NEAR(found.stage_temperature, 87.6, 1e-9);
}

TEST(PowerStage, ItsExchangeIsThatOfTheBudget) {
  const hal::ModbusExchange exchange{"power stage", hal::power_stage_written_words, hal::power_stage_read_words, 1,
                                     0.02};
  EXPECT_NO_THROW(hal::check(hal::modbus_budget("/dev/ttyS0", 115200, {exchange})));
}

void expect_exchange(hal::ModbusClient& client) {
  hal::PowerStageCommand command;
  command.enable = true;
  command.velocity = 0.125;
  EXPECT_TRUE(comes_true([&] {
    client.command(std::span(&command, 1));
    return client.feedback()[0].state.velocity == 0.125;
  })) << client.last_error();
}

TEST(ModbusClient, DrivesAStageOverTcp) {
  Stage stage("127.0.0.1:0");
  hal::PowerStageState state;
  state.limit_positive = true;
  state.position = 0.31415926;
  state.velocity = 0.125;
  stage.set(state);
  hal::ModbusClient client(config_for(local(stage.port())));
  expect_exchange(client);
  EXPECT_TRUE(client.feedback()[0].state.limit_positive);
  EXPECT_NEAR(client.feedback()[0].state.position, 0.31415926, 5e-9);
  EXPECT_TRUE(comes_true([&] { return stage.command().velocity == 0.125 && stage.command().enable; }));
  EXPECT_EQ(client.feedback()[0].fault, Fault::none);
}

TEST(ModbusClient, DrivesAStageOverASerialLine) {
  const SerialPair line;
  Stage stage(line.name(0));
  hal::PowerStageState state;
  state.velocity = 0.125;
  stage.set(state);
  hal::ModbusClient client(config_for(line.name(1), 0.2));
  expect_exchange(client);
  EXPECT_TRUE(comes_true([&] { return stage.command().velocity == 0.125; }));
}

TEST(ModbusClient, DrivesAStageOfPymodbusOverTcp) {
  if (!has_pymodbus()) GTEST_SKIP() << "python3-pymodbus is not installed";
  const int port = free_port();
  const Process slave(pymodbus("slave tcp " + std::to_string(port) + " 21332"));
  ASSERT_TRUE(comes_true([&] { return RawClient(port).connected(); }));
  hal::ModbusClient client(config_for(local(port)));
  expect_exchange(client);
}

TEST(ModbusClient, DrivesAStageOfPymodbusOverASerialLine) {
  if (!has_pymodbus()) GTEST_SKIP() << "python3-pymodbus is not installed";
  const SerialPair line;
  const Process slave(pymodbus("slave rtu " + line.name(0) + " 21332"));
  std::unique_ptr<hal::ModbusClient> client;
  // Until the slave listens; each try waits for a second.
  for (int tries = 0; tries < 60 && !client; ++tries) try {
      client = std::make_unique<hal::ModbusClient>(config_for(line.name(1), 0.2));
    } catch (const hal::ModbusError&) {
    }
  ASSERT_TRUE(client) << "no slave within a minute";
  expect_exchange(*client);
}

std::string refusal_of(const hal::ModbusClientConfig& config) {
  try {
    const hal::ModbusClient client(config);
  } catch (const hal::ModbusError& error) {
    return error.what();
  }
  return "started";
}

TEST(ModbusClient, RefusesToStartWithoutItsSlave) {
  const int port = free_port();
  EXPECT_EQ(
      refusal_of(config_for(local(port))),
      local(port) + ": cannot connect: Connection refused; check that the slave has power and the address is right");
  EXPECT_EQ(refusal_of(config_for("/dev/nowhere")),
            "/dev/nowhere: cannot be opened: No such file or directory; is it plugged in, and is the name right?");
  const SerialPair line;
  EXPECT_EQ(
      refusal_of(config_for(line.name(0))),
      line.name(0) + ", unit 1: no answer within 1000 ms; check that it has power and that rate and unit are right");
}

TEST(ModbusClient, RefusesToStartWithOtherRegisters) {
  hal::ModbusServerConfig config;
  config.address = "127.0.0.1:0";
  const hal::ModbusServer other(hal::RegisterMap(small_registers()), config, small_values);
  EXPECT_EQ(refusal_of(config_for(local(other.port()))),
            local(other.port()) +
                ", unit 1: found the registers 0x0003 version 0; expected 0x5354 version 1 to 2 at addresses 0 and 1");
}

TEST(ModbusClient, ReportsASilentSlaveAsFramesLostAndRecovers) {
  auto stage = std::make_unique<Stage>("127.0.0.1:0");
  const std::string address = local(stage->port());
  hal::ModbusClient client(config_for(address));
  EXPECT_TRUE(comes_true([&] { return client.feedback()[0].time_ns != 0; }));
  stage.reset();
  EXPECT_TRUE(comes_true([&] { return client.feedback()[0].fault == Fault::frames_lost; }));
  // Never before the third exchange without a new state.
  EXPECT_GE(client.feedback()[0].failures, 3U);
  EXPECT_NE(client.last_error().find(address + ", unit 1: "), std::string::npos) << client.last_error();
  stage = std::make_unique<Stage>(address);
  EXPECT_TRUE(comes_true([&] { return client.feedback()[0].fault == Fault::none; })) << client.last_error();
}

TEST(ModbusClient, TakesTheSameStateAgainForNone) {
  Stage stage("127.0.0.1:0");
  hal::ModbusClient client(config_for(local(stage.port()), 0.05));
  EXPECT_TRUE(comes_true([&] { return client.feedback()[0].time_ns != 0; }));
  stage.freeze();
  EXPECT_TRUE(comes_true([&] { return client.feedback()[0].fault == Fault::frames_lost; }));
  EXPECT_NE(client.last_error().find("found the same cycle again; expected a new state"), std::string::npos);
}

TEST(ModbusClient, SwitchesTheStageOffWhenTheLoopFallsSilentOrTheClientEnds) {
  Stage stage("127.0.0.1:0");
  auto client = std::make_unique<hal::ModbusClient>(config_for(local(stage.port()), 0.05));
  hal::PowerStageCommand on;
  on.enable = true;
  const auto switched_on = [&] {
    client->command(std::span(&on, 1));
    return stage.command().enable;
  };
  EXPECT_TRUE(comes_true(switched_on));
  EXPECT_TRUE(comes_true([&] { return !stage.command().enable; }));  // no further command
  EXPECT_TRUE(comes_true(switched_on));
  client.reset();
  EXPECT_FALSE(stage.command().enable);
}

// One axis over a loop of 10 ms.
TEST(ModbusBackend, CarriesAnAxisBetweenTheLoopAndAStage) {
  auto stage = std::make_unique<Stage>("127.0.0.1:0");
  hal::PowerStageState state;
  state.position = -0.25;
  state.current = 1.5;
  state.limit_negative = true;
  state.has_torque_off = state.has_dc_link = state.torque_off_b = true;
  state.dc_link = 48.5;
  stage->set(state);
  hal::ModbusClient client(config_for(local(stage->port()), 0.02));
  hal::TickClock clock(10'000'000);
  hal::ModbusBackend backend(client, clock);
  ASSERT_EQ(backend.axis_count(), 1U);
  EXPECT_EQ(backend.motor_signals(0), (MotorSignalSet{.dc_link = true, .torque_off = true}));
  std::array<Feedback<FixedSignals>, 1> feedback{};
  std::array<DigitalInputs<FixedSignals>, 1> inputs{};
  std::array<Command<FixedSignals>, 1> command{};
  command[0].enable = true;
  command[0].voltage[0] = FixedSignals::Voltage::from_raw(-(12 << 18));  // -12 V
  const auto tick = [&] {
    const std::int64_t now = backend.wait_for_tick();
    backend.read(feedback);
    backend.read_inputs(inputs);
    EXPECT_LE(feedback[0].position_time_ns, now);
    backend.set_brake(0, true);
    backend.write(command);
  };
  EXPECT_TRUE(comes_true([&] {
    tick();
    return stage->command().voltage == -12.0;
  }));
  EXPECT_TRUE(stage->command().enable);
  EXPECT_TRUE(stage->command().release_brake);
  EXPECT_TRUE(feedback[0].position_valid);
  // Half a step of the register, 5 nm.
  EXPECT_NEAR(std::ldexp(static_cast<double>(feedback[0].position.raw()), -40), -0.25, 5e-9);
  EXPECT_EQ(feedback[0].current[0].raw(), 3 << 19);
  EXPECT_TRUE(inputs[0].limit_negative);
  EXPECT_EQ(backend.fault(0), Fault::none);
  std::array<ProtectionInputs<FixedSignals>, 1> protection{};
  backend.read_protection(protection);
  EXPECT_EQ(protection[0].dc_link.raw(), 97 << 17);  // 48.5 V
  EXPECT_FALSE(protection[0].torque_off_a);
  EXPECT_TRUE(protection[0].torque_off_b);

  command[0].enable = false;
  EXPECT_TRUE(comes_true([&] {
    tick();
    return stage->command().voltage == 0.0 && !stage->command().enable;
  }));
  stage.reset();
  EXPECT_TRUE(comes_true([&] {
    tick();
    return backend.fault(0) == Fault::frames_lost;
  }));
}

}  // namespace
}  // namespace stiction::test
