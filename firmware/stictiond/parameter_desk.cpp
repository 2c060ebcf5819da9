#include "firmware/stictiond/parameter_desk.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "hal/tick_clock.hpp"

namespace stiction::drive {
namespace {

std::int64_t desk_now_ns() { return hal::MonotonicTime().now_ns(); }

}  // namespace

ParameterDesk::ParameterDesk(const machine::Machine& machine, const machine::DriveSetup& setup, KeptParameters kept)
    : registers_(machine, setup, kept.begun),
      kept_parameters_(std::move(kept)),
      window_(setup.modbus_server.value_or(machine::ModbusServerSetup{}).commissioning_time),
      stored_(std::make_shared<Stored>(kept_parameters_.file_holds)),
      kept_(kept_parameters_.begun) {}

void ParameterDesk::show(PublishedState& state) const {
  state.commissioning_seconds = window_.seconds_left(desk_now_ns());
  state.store_result = stored_->result.load();
}

void ParameterDesk::open_commissioning() {
  window_.open(desk_now_ns());
  said_->say(fmt::format("clients may write parameters for {:g} s", window_.length_s()), desk_now_ns());
}

void ParameterDesk::close_commissioning() {
  window_.close();
  said_->say("clients may not write parameters any more", desk_now_ns());
}

std::optional<hal::ModbusException> ParameterDesk::rejection_of(std::span<const ParameterWrite> parameters, bool store,
                                                                const char* bus) {
  const std::int64_t now_ns = desk_now_ns();
  if (!parameters.empty()) {
    const std::lock_guard lock(mutex_);
    if (!limit_.take(now_ns)) return hal::ModbusException::busy;
  }
  if ((store || !parameters.empty()) && !window_.is_open(now_ns)) {
    said_->say(fmt::format("{}: {} is refused: the commissioning window is closed; expected that an operator of this "
                           "computer opens it (SIGUSR1)",
                           bus, parameters.empty() ? "store_parameters" : parameters.front().key),
               now_ns);
    return hal::ModbusException::illegal_function;
  }
  for (const auto& parameter : parameters)
    if (const auto reason = registers_.rejection_of(parameter); !reason.empty()) {
      said_->say(fmt::format("{}: {}", bus, reason), now_ns);
      return hal::ModbusException::illegal_value;
    }
  return {};
}

hal::WriteVerdict ParameterDesk::take(std::span<const ParameterWrite> parameters, bool store, const char* bus) {
  for (const ParameterWrite& parameter : parameters) {
    registers_.remember(parameter);
    said_->say(fmt::format("{}: {} = {}, which takes effect at the next start if it is stored", bus, parameter.key,
                           parameter.value),
               desk_now_ns());
  }
  return store ? ask_store(bus) : hal::WriteVerdict{};
}

hal::WriteVerdict ParameterDesk::ask_store(const char* bus) {
  if (kept_parameters_.file.empty()) {
    said_->say(fmt::format("{}: parameters are not stored: the drive was started without --parameters", bus),
               desk_now_ns());
    return {.refused = hal::ModbusException::device_failure};
  }
  const std::lock_guard lock(mutex_);
  asked_ = registers_.written();
  stored_->result = StoreResult::under_way;
  const auto ticket = disk_.ask([set = *asked_, check = kept_parameters_.check, said = said_, stored = stored_,
                                 file = kept_parameters_.file.string(), name = std::string(bus)] {
    auto ends = StoreResult::rejected;
    try {
      if (check) check(set);
      ends = StoreResult::not_written;
      write_parameters(file, set, stored->file_holds ? KeepAsPrevious::the_file : KeepAsPrevious::what_is_there);
    } catch (const std::exception& error) {
      stored->result = ends;
      said->say(fmt::format("{}: parameters are not stored: {}", name, error.what()), desk_now_ns());
      throw;
    }
    stored->file_holds = true;
    stored->result = StoreResult::stored;
    said->say(fmt::format("{}: parameters stored in {}", name, file), desk_now_ns());
  });
  return {.put_off = ticket};
}

std::optional<hal::WriteVerdict> ParameterDesk::outcome(std::uint64_t ticket) {
  const std::lock_guard lock(mutex_);
  switch (disk_.outcome(ticket)) {
    case StoreThread::Outcome::under_way:
      return {};
    case StoreThread::Outcome::stored:
      kept_ = asked_;
      return hal::WriteVerdict{};
    case StoreThread::Outcome::failed:
      // A value that refuses a start would refuse every set that follows.
      if (stored_->result == StoreResult::rejected) registers_.take_back(kept_);
      break;
  }
  return hal::WriteVerdict{.refused = hal::ModbusException::device_failure};
}

}  // namespace stiction::drive
