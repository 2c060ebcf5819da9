#include "firmware/stictiond/object_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "firmware/version/version.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::drive {
namespace {

using hal::can::ObjectAddress, hal::can::SdoAbort, hal::can::SdoWritten;

constexpr double save_signature = 0x6576'6173;  // "save" (CiA 301, 7.5.2.13)

SdoAbort abort_of(hal::ModbusException exception) {
  switch (exception) {
    case hal::ModbusException::illegal_function:
      return SdoAbort::local_control;
    case hal::ModbusException::illegal_value:
      return SdoAbort::value;
    case hal::ModbusException::busy:
      return SdoAbort::device_state;
    default:
      return SdoAbort::not_stored;
  }
}

SdoWritten written_of(const hal::WriteVerdict& verdict) {
  return {verdict.refused ? abort_of(*verdict.refused) : SdoAbort::none, verdict.put_off};
}

// The lowest byte first.
double raw_of(std::span<const std::uint8_t> bytes, bool is_signed) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) word |= std::uint64_t{bytes[i]} << (8 * i);
  const std::size_t unused = 64 - 8 * bytes.size();
  if (!is_signed) return static_cast<double>(word);
  return static_cast<double>(static_cast<std::int64_t>(word << unused) >> unused);
}

std::vector<std::uint8_t> bytes_of(double raw, const ObjectTypeRow& type) {
  const auto word =
      static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(std::round(raw), type.low, type.high)));
  std::vector<std::uint8_t> bytes(type.bytes);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(word >> (8 * i));
  return bytes;
}

// A decimal increment is none of binary fractions: what was read and is written back is to be the same value.
double si_of(double raw, double unit) {
  const double units = std::round(1.0 / unit);
  return std::abs(units * unit - 1.0) < 1e-9 ? raw / units : raw * unit;
}

SdoAbort range_abort(const hal::Register& r, double value) {
  if (value > r.high) return SdoAbort::value_too_high;
  if (r.low_open ? value <= r.low : value < r.low) return SdoAbort::value_too_low;
  return SdoAbort::none;
}

}  // namespace

class ObjectServer::Node : public hal::can::ServedObjects {
 public:
  Node(ObjectServer& server, std::size_t axis)
      : server_(server), axis_(axis), link_(server.links_->at(axis)), sdo_(server.config_.nodes[axis], *this) {
    const auto registers = server.desk_->registers().map().registers();
    const std::string& name = server.configuration_.names.at(axis);
    for (const Object& object : object_table()) {
      const bool is_register = object.source == ObjectSource::state || object.source == ObjectSource::command ||
                               object.source == ObjectSource::parameter;
      const std::string wanted = is_register ? source_name(object, name) : "";
      const auto found = std::find_if(registers.begin(), registers.end(),
                                      [&](const hal::Register& r) { return is_register && r.name == wanted; });
      if (is_register && found == registers.end())
        throw std::logic_error(fmt::format("object {:04x}h: found no register {}", object.index, wanted));
      places_.push_back(static_cast<std::size_t>(found - registers.begin()));
    }
  }

  hal::can::SdoServer& sdo() { return sdo_; }
  bool answers() const { return link_.state.load() != hal::can::NodeState::stopped; }

  std::variant<std::vector<std::uint8_t>, SdoAbort> read(ObjectAddress address) override {
    const Object* object = object_at(address.index, address.sub);
    if (object == nullptr) return missing(address);
    if (object->source == ObjectSource::text) {
      const std::string text = text_of(*object);
      return std::vector<std::uint8_t>(text.begin(), text.end());
    }
    const double raw = raw_of_object(*object);
    if (std::isnan(raw)) return SdoAbort::no_data;
    return bytes_of(raw, row_of(object->type));
  }

  SdoAbort write_rejection(ObjectAddress address) override {
    const Object* object = object_at(address.index, address.sub);
    if (object == nullptr) return missing(address);
    return object->access == ObjectAccess::write ? SdoAbort::none : SdoAbort::read_only;
  }

  SdoWritten write(ObjectAddress address, std::span<const std::uint8_t> bytes, bool exact) override {
    const Object& object = *object_at(address.index, address.sub);
    const ObjectTypeRow& type = row_of(object.type);
    if (bytes.size() < type.bytes) return {.abort = SdoAbort::too_short};
    if (exact && bytes.size() > type.bytes) return {.abort = SdoAbort::too_long};
    const double raw = raw_of(bytes.first(type.bytes), type.low < 0.0);
    if (object.source == ObjectSource::command) return {.abort = command(object, raw)};
    if (object.source == ObjectSource::parameter) return {.abort = parameter(object, raw)};
    return own(object, raw);
  }

  std::optional<SdoWritten> outcome(std::uint64_t ticket) override {
    const auto verdict = server_.desk_->outcome(ticket);
    return verdict ? std::optional(written_of(*verdict)) : std::nullopt;
  }

 private:
  static SdoAbort missing(ObjectAddress address) {
    return has_index(address.index) ? SdoAbort::no_sub_index : SdoAbort::no_object;
  }
  std::size_t place_of(const Object& object) const {
    return places_[static_cast<std::size_t>(&object - object_table().data())];
  }
  double unit_of(const Object& object) const { return value_of(object.unit, server_.config_.increment); }
  const hal::Register& register_of(const Object& object) const {
    return server_.desk_->registers().map().registers()[place_of(object)];
  }

  std::string text_of(const Object& object) const {
    const std::string_view of = object.of;
    return of == "machine" ? server_.configuration_.machine.id : of == "version" ? program_version() : std::string(of);
  }

  double raw_of_object(const Object& object) {
    switch (object.source) {
      case ObjectSource::number:
        return object.number;
      case ObjectSource::node_id:
        return object.number + server_.config_.nodes[axis_];
      case ObjectSource::setup:
        return object.setup(server_.configuration_, axis_);
      case ObjectSource::node:
        return own_value(object);
      default:
        server_.state();
        return value_in_force(object) / unit_of(object);
    }
  }

  double value_in_force(const Object& object) const {
    const double value = server_.values_[place_of(object)];
    return std::isnan(value) && object.setup != nullptr ? object.setup(server_.configuration_, axis_) : value;
  }

  std::uint32_t errors() const { return std::min<std::uint32_t>(link_.error_count - cleared_, NodeLink::kept_errors); }
  double own_value(const Object& object) {
    switch (object.index) {
      case 0x1001:
        return hal::can::error_register_of(error_code_of(server_.state().axes[axis_].fault));
      case 0x1003:
        if (object.sub == 0) return errors();
        if (object.sub > errors()) return std::numeric_limits<double>::quiet_NaN();
        return link_.newest_errors[(link_.error_count - object.sub) % NodeLink::kept_errors];
      case 0x1010:
        return 1;  // stores when it is asked to, and not by itself
      case 0x1016:
        return link_.watched;
      default:
        return link_.heartbeat_ms;
    }
  }

  // Whether who commands over this bus may; a stop is taken from everybody.
  SdoAbort permission(bool stop) {
    if (!server_.config_.motion_allowed || (server_.moves_itself_ && !stop)) return SdoAbort::local_control;
    if (server_.stale_ && server_.stale_()) return SdoAbort::device_state;
    const auto owner = server_.state().axes[axis_].owner;
    const bool other = owner != CommandSource::none && owner != CommandSource::can;
    return other && !stop ? SdoAbort::local_control : SdoAbort::none;
  }

  SdoAbort command(const Object& object, double raw) {
    const hal::Register& r = register_of(object);
    const double value = si_of(raw, unit_of(object));
    auto write = std::get<MotionWrite>(server_.desk_->registers().meaning_of({place_of(object), value}));
    if (write.what == MotionWrite::What::mode) {
      if (!is_supported(static_cast<std::int8_t>(raw))) return SdoAbort::value;
    } else if (const auto refused = range_abort(r, value); refused != SdoAbort::none) {
      return refused;
    } else if (!r.choices.empty() && std::find(r.choices.begin(), r.choices.end(), value) == r.choices.end()) {
      return SdoAbort::value;
    }
    // The number that is none (CiA 402, of process data).
    if (raw == static_cast<double>(std::numeric_limits<std::int32_t>::min())) return SdoAbort::value_too_low;
    if (const auto refused = permission(MotionMailbox::stops(write)); refused != SdoAbort::none) return refused;
    server_.loop_.put(std::span(&write, 1));
    server_.desk_->said().say(fmt::format("CAN: {} = {}", r.name, value), hal::MonotonicTime().now_ns());
    return SdoAbort::none;
  }

  SdoAbort parameter(const Object& object, double raw) {
    const hal::Register& r = register_of(object);
    const ParameterWrite write{r.name, si_of(raw, unit_of(object))};
    if (const auto refused = range_abort(r, write.value); refused != SdoAbort::none) return refused;
    if (const auto refused = server_.desk_->rejection_of(std::span(&write, 1), false, "CAN")) return abort_of(*refused);
    server_.desk_->take(std::span(&write, 1), false, "CAN");
    return SdoAbort::none;
  }

  SdoWritten own(const Object& object, double raw) {
    if (object.index == 0x1003) {
      if (raw != 0.0) return {.abort = SdoAbort::value};
      cleared_ = link_.error_count;
      return {};
    }
    if (object.index == 0x1010) {
      if (raw != save_signature) return {.abort = SdoAbort::not_stored};
      if (const auto refused = server_.desk_->rejection_of({}, true, "CAN")) return {.abort = abort_of(*refused)};
      return written_of(server_.desk_->take({}, true, "CAN"));
    }
    if (object.index == 0x1017) {
      link_.heartbeat_ms = static_cast<std::uint16_t>(raw);
      return {};
    }
    // The watch over the commander of this bus is its own.
    if (const auto refused = permission(false); refused != SdoAbort::none) return {.abort = refused};
    const auto watched = static_cast<std::uint32_t>(raw);
    if ((watched >> 16) > hal::can::highest_node) return {.abort = SdoAbort::value};
    link_.watched = watched;
    return {};
  }

  ObjectServer& server_;
  std::size_t axis_;
  NodeLink& link_;
  hal::can::SdoServer sdo_;
  std::vector<std::size_t> places_;  // register of each object
  std::uint32_t cleared_ = 0;        // errors before it are not shown any more
};

ObjectServer::ObjectServer(const DriveConfiguration& configuration, const CanServerConfig& config,
                           std::shared_ptr<ParameterDesk> desk, std::shared_ptr<NodeLinks> links, Stale stale,
                           bool moves_itself)
    : configuration_(configuration),
      config_(config),
      desk_(std::move(desk)),
      links_(std::move(links)),
      stale_(std::move(stale)),
      moves_itself_(moves_itself),
      values_(desk_->registers().map().registers().size()) {
  for (std::size_t i = 0; i < config_.nodes.size(); ++i) nodes_.push_back(std::make_unique<Node>(*this, i));
}

ObjectServer::~ObjectServer() = default;

const PublishedState& ObjectServer::state() {
  state_ = loop_.latest();
  desk_->show(state_);
  if (stale_ && stale_()) mark_stale(state_);
  desk_->registers().put_values(state_, values_);
  return state_;
}

std::optional<hal::can::Frame> ObjectServer::answer(const hal::can::Frame& request, std::int64_t now_ns) {
  for (const auto& node : nodes_) {
    if (!node->answers()) continue;
    if (auto frame = node->sdo().answer(request, now_ns)) return frame;
  }
  return {};
}

void ObjectServer::poll(std::int64_t now_ns, const std::function<void(const hal::can::Frame&)>& send) {
  for (const auto& node : nodes_)
    if (const auto frame = node->sdo().poll(now_ns)) send(*frame);
}

}  // namespace stiction::drive
