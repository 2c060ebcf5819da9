#include "hal/modbus/client.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "hal/bus_budget.hpp"
#include "hal/modbus/off_request.hpp"
#include "hal/modbus/serial_line.hpp"
#include "hal/power_cut.hpp"

namespace stiction::hal {
namespace {

constexpr int misses_until_fault = 3;  // as for every node of a bus
constexpr double start_timeout = 1.0;  // s
constexpr double answer_share = 0.8;   // of its part of the period that a slave may take

std::int64_t now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

void sleep_until(std::int64_t time_ns) {
  const timespec time{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

std::string time_text(double seconds) { return fmt::format("{:g} ms", seconds * 1e3); }

}  // namespace

// libmodbus' context with the words of the exchange; every call says in words what failed.
class ModbusClient::Line {
 public:
  explicit Line(const ModbusClientConfig& config) : device_(config.device), serial_(is_serial_device(config.device)) {
    if (serial_) {
      context_ = open_serial_line(config.device, config.baud_rate, config.units.front());
      silence_ns_ = static_cast<std::int64_t>(modbus_rtu_silence(config.baud_rate) * 1e9);
    } else {
      const auto [host, port] = host_and_port(config.device);
      context_.reset(modbus_new_tcp_pi(host.c_str(), port.c_str()));
      set_timeout(start_timeout);
      if (!context_ || modbus_connect(context_.get()) != 0)
        throw ModbusError(fmt::format("{}: cannot connect: {}; check that the slave has power and the address is right",
                                      device_, modbus_strerror(errno)));
    }
    set_timeout(start_timeout);
    for (const int unit : config.units)
      off_requests_.push_back(off_request(unit, serial_ ? ModbusTransport::rtu : ModbusTransport::tcp));
    descriptor_ = modbus_get_socket(context_.get());
  }

  void switch_off() const noexcept {
    for (const auto& request : off_requests_) {
      // What the line does not take at once is lost: nothing may wait here.
      [[maybe_unused]] const ssize_t sent =
          serial_ ? ::write(descriptor_, request.data(), request.size())
                  : ::send(descriptor_, request.data(), request.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }

  void set_timeout(double seconds) {
    timeout_ = seconds;
    const auto us = static_cast<std::uint32_t>(seconds * 1e6);
    if (context_) modbus_set_response_timeout(context_.get(), us / 1'000'000, us % 1'000'000);
  }

  // The schema of its registers. Throws ModbusError where another slave answers, or none.
  std::uint16_t identify(int unit) {
    std::array<std::uint16_t, 2> words{};
    select(unit);
    if (modbus_read_registers(context_.get(), power_stage_read, words.size(), words.data()) < 0)
      throw ModbusError(fmt::format("{}; check that it has power and that rate and unit are right", failure(unit)));
    if (words[0] != power_stage_identification || words[1] < oldest_power_stage_schema || words[1] > power_stage_schema)
      throw ModbusError(fmt::format(
          "{}, unit {}: found the registers {:#06x} version {}; expected {:#06x} version {} to {} at addresses 0 and 1",
          device_, unit, words[0], words[1], power_stage_identification, oldest_power_stage_schema,
          power_stage_schema));
    return words[1];
  }

  // Empty: the words of the state came.
  std::string exchange(int unit, std::span<const std::uint16_t, power_stage_written_words> written,
                       std::span<std::uint16_t> read) {
    if (broken_ && !reconnect()) return failure(unit);
    select(unit);
    if (modbus_write_and_read_registers(context_.get(), power_stage_written, written.size(), written.data(),
                                        power_stage_read, static_cast<int>(read.size()), read.data()) >= 0)
      return {};
    const int error = errno;
    broken_ = !serial_ && (error == EPIPE || error == ECONNRESET || error == EBADF || error == ENOTCONN);
    // What comes late is not the answer to the next request.
    if (!broken_) modbus_flush(context_.get());
    errno = error;
    return failure(unit);
  }

  std::string changed(int unit) const {
    return fmt::format("{}, unit {}: found different registers than at the start", device_, unit);
  }
  std::string frozen(int unit) const {
    return fmt::format("{}, unit {}: found the same cycle again; expected a new state", device_, unit);
  }

 private:
  void select(int unit) {
    modbus_set_slave(context_.get(), unit);
    if (serial_) sleep_until(now_ns() + silence_ns_);
  }
  bool reconnect() {
    modbus_close(context_.get());
    broken_ = modbus_connect(context_.get()) != 0;
    descriptor_ = modbus_get_socket(context_.get());
    return !broken_;
  }
  std::string failure(int unit) const {
    const int error = errno;
    if (error == ETIMEDOUT) return fmt::format("{}, unit {}: no answer within {}", device_, unit, time_text(timeout_));
    return fmt::format("{}, unit {}: {}", device_, unit, modbus_strerror(error));
  }

  std::string device_;
  bool serial_;
  ModbusContext context_;
  std::vector<OffRequest> off_requests_;
  std::atomic<int> descriptor_{-1};  // another thread or a signal handler writes to it
  std::int64_t silence_ns_ = 0;
  double timeout_ = 0.0;
  bool broken_ = false;
};

ModbusClient::ModbusClient(const ModbusClientConfig& config)
    : config_(config),
      commands_(std::vector<PowerStageCommand>(config.units.size())),
      feedback_(std::vector<PowerStageFeedback>(config.units.size())),
      newest_(config.units.size()),
      misses_(config.units.size()) {
  if (config_.units.empty()) throw ModbusError(fmt::format("{}: no unit given", config_.device));
  line_ = std::make_unique<Line>(config_);
  for (const int unit : config_.units) schemas_.push_back(line_->identify(unit));
  line_->set_timeout(answer_share * config_.period / static_cast<double>(config_.units.size()));
  exchange_all();
  thread_ = std::thread([this] { run(); });
}

ModbusClient::~ModbusClient() {
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

void ModbusClient::cut_power() noexcept { line_->switch_off(); }

void ModbusClient::command(std::span<const PowerStageCommand> commands) {
  auto& next = commands_.next();
  std::copy_n(commands.begin(), std::min(commands.size(), next.size()), next.begin());
  commands_.publish();
}

std::string ModbusClient::last_error() const {
  const std::lock_guard lock(error_mutex_);
  return last_error_;
}

void ModbusClient::run() {
  const auto period_ns = static_cast<std::int64_t>(config_.period * 1e9);
  std::int64_t next = now_ns() + period_ns;
  while (!stop_.load(std::memory_order_relaxed)) {
    sleep_until(next);
    exchange_all();
    // A slave that took longer than the period does not make the next exchanges hurry.
    next += period_ns;
    if (const std::int64_t late = now_ns() - next; late > 0) next += (late / period_ns + 1) * period_ns;
  }
  stale_commands_ = misses_until_fault;
  for (std::size_t axis = 0; axis < newest_.size(); ++axis) exchange(axis, {});
}

void ModbusClient::exchange_all() {
  const auto& commands = commands_.latest();
  stale_commands_ = commands_.is_new() ? 0 : stale_commands_ + 1;
  const bool off = stale_commands_ >= misses_until_fault || power_cut.is_cut();
  ++cycle_;
  for (std::size_t axis = 0; axis < newest_.size(); ++axis) exchange(axis, off ? PowerStageCommand{} : commands[axis]);
  feedback_.next() = newest_;
  feedback_.publish();
}

void ModbusClient::exchange(std::size_t axis, PowerStageCommand command) {
  const int unit = config_.units[axis];
  PowerStageFeedback& feedback = newest_[axis];
  std::array<std::uint16_t, power_stage_written_words> written{};
  std::array<std::uint16_t, power_stage_read_words> read{};
  command.cycle = cycle_;
  put_words(command, written);
  const std::int64_t asked_ns = now_ns();
  std::string error = line_->exchange(unit, written, std::span(read).first(words_of_schema(schemas_[axis])));
  if (error.empty() && (read[0] != power_stage_identification || read[1] != schemas_[axis]))
    error = line_->changed(unit);
  const PowerStageState state = state_in(read);
  if (error.empty() && feedback.time_ns != 0 && state.cycle == feedback.state.cycle) error = line_->frozen(unit);
  if (error.empty()) {
    feedback.state = state;
    feedback.time_ns = asked_ns + (now_ns() - asked_ns) / 2;
    misses_[axis] = 0;
  } else {
    ++misses_[axis];
    ++feedback.failures;
    const std::lock_guard lock(error_mutex_);
    last_error_ = error;
  }
  feedback.fault = misses_[axis] >= misses_until_fault ? Fault::frames_lost : Fault::none;
}

}  // namespace stiction::hal
