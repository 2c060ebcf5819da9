#include "hal/can/dbc.hpp"

#include <cmath>
#include <cstdio>
#include <vector>

#include "hal/can/process_data.hpp"

namespace stiction::hal::can {
namespace {

struct Signal {
  const char* name;
  int first_bit;
  int bits;
  bool is_signed;
  int fraction_bits;  // the value is raw * 2^-fraction_bits
  const char* unit;
  double scale = 1.0;  // and times this
};

struct Message {
  const char* name;
  std::uint32_t id;
  bool of_drive;
  std::size_t size_index;  // in FormatProperties::sizes
  std::vector<Signal> signals;
};

using S = FixedSignals;
constexpr int current_bits = S::Current::fraction_bits, voltage_bits = S::Voltage::fraction_bits;

std::vector<Signal> flags(int first_bit) {
  std::vector<Signal> signals;
  for (const char* name :
       {"valid", "fault", "limit_negative", "limit_positive", "home", "index_passed", "torque_off_a", "torque_off_b"})
    signals.push_back({name, first_bit++, 1, false, 0, ""});
  return signals;
}

std::vector<Message> messages(Format format) {
  if (format == Format::fd) {
    Message feedback{"feedback", position_id, false, 2, flags(36 * 8)};
    feedback.signals.insert(feedback.signals.end(), {{"position", 0, 64, true, S::Position::fraction_bits, "m"},
                                                     {"velocity", 64, 32, true, S::Velocity::fraction_bits, "m/s"},
                                                     {"current_A", 96, 32, true, current_bits, "A"},
                                                     {"current_B", 128, 32, true, current_bits, "A"},
                                                     {"current_C", 160, 32, true, current_bits, "A"},
                                                     {"sample_age", 192, 32, false, 0, "ns"},
                                                     {"index_position", 224, 64, true, S::Position::fraction_bits, "m"},
                                                     {"counter", 296, 8, false, 0, ""},
                                                     {"dc_link", 304, 30, true, voltage_bits, "V"},
                                                     {"motor_temperature", 334, 13, true, 0, "degC", 0.1},
                                                     {"stage_temperature", 347, 13, true, 0, "degC", 0.1},
                                                     {"hall", 360, 3, false, 0, ""},
                                                     {"has_hall", 363, 1, false, 0, ""},
                                                     {"has_dc_link", 364, 1, false, 0, ""},
                                                     {"has_motor_temperature", 365, 1, false, 0, ""},
                                                     {"has_stage_temperature", 366, 1, false, 0, ""},
                                                     {"has_torque_off", 367, 1, false, 0, ""},
                                                     {"checksum", 368, 16, false, 0, ""}});
    return {{"command",
             command_id,
             true,
             1,
             {{"voltage_A", 0, 32, true, voltage_bits, "V"},
              {"voltage_B", 32, 32, true, voltage_bits, "V"},
              {"voltage_C", 64, 32, true, voltage_bits, "V"},
              {"enable", 96, 1, false, 0, ""},
              {"counter", 104, 8, false, 0, ""},
              {"checksum", 112, 16, false, 0, ""}}},
            feedback};
  }
  const Signal counter{"counter", 52, 4, false, 0, ""}, checksum{"checksum", 56, 8, false, 0, ""};
  const auto all = flags(48);
  return {{"command",
           command_id,
           true,
           1,
           {{"voltage_A", 0, 16, true, 5, "V"},
            {"voltage_B", 16, 16, true, 5, "V"},
            {"voltage_C", 32, 16, true, 5, "V"},
            {"enable", 48, 1, false, 0, ""},
            counter,
            checksum}},
          {"position",
           position_id,
           false,
           2,
           {{"position", 0, 48, true, 32, "m"}, all[0], all[1], all[2], all[3], counter, checksum}},
          {"current",
           current_id,
           false,
           3,
           {{"current_A", 0, 16, true, 8, "A"},
            {"current_B", 16, 16, true, 8, "A"},
            {"current_C", 32, 16, true, 8, "A"},
            {"home", 48, 1, false, 0, ""},
            {"index_passed", 49, 1, false, 0, ""},
            {"torque_off_a", 50, 1, false, 0, ""},
            {"torque_off_b", 51, 1, false, 0, ""},
            counter,
            checksum}}};
}

std::string line_of(const Signal& s, const std::string& receiver) {
  char text[160];
  std::snprintf(text, sizeof text, " SG_ %s : %d|%d@1%c (%.17g,0) [0|0] \"%s\" %s\n", s.name, s.first_bit, s.bits,
                s.is_signed ? '-' : '+', s.scale * std::ldexp(1.0, -s.fraction_bits), s.unit, receiver.c_str());
  return text;
}

struct ServerMessage {
  const char* name;
  Pdo pdo;
  std::vector<Signal> signals;
};

std::vector<ServerMessage> server_messages(double increment) {
  const double speed = 1000.0 * increment;
  const Signal controlword{"controlword", 0, 16, false, 0, ""}, statusword{"statusword", 0, 16, false, 0, ""};
  const Signal position{"actual_position", 16, 32, true, 0, "m", increment};
  return {{"mode", Pdo::mode, {controlword, {"mode_of_operation", 16, 8, true, 0, ""}}},
          {"target", Pdo::target, {controlword, {"target_position", 16, 32, true, 0, "m", increment}}},
          {"offsets",
           Pdo::offsets,
           {{"velocity_offset", 0, 32, true, 0, "m/s", speed}, {"torque_offset", 32, 16, true, 0, "%", 0.1}}},
          {"state", Pdo::position, {statusword, position}},
          {"state", Pdo::position_and_torque, {statusword, position, {"actual_torque", 48, 16, true, 0, "%", 0.1}}},
          {"motion",
           Pdo::motion,
           {{"actual_velocity", 0, 32, true, 0, "m/s", speed}, {"following_error", 32, 32, true, 0, "m", increment}}},
          {"speed", Pdo::speed, {controlword, {"target_velocity", 16, 32, true, 0, "m/s", speed}}},
          {"torque",
           Pdo::torque,
           {controlword, {"target_torque", 16, 16, true, 0, "%", 0.1}, {"max_torque", 32, 16, false, 0, "%", 0.1}}}};
}

struct NetworkMessage {
  const char* name;
  CobId use;
  std::size_t size;
  bool of_drive;
  std::vector<Signal> signals;
};

// What CANopen has beside process data (network.hpp, sdo.hpp); the data of an SDO are those of its object.
std::vector<NetworkMessage> network_messages() {
  const std::vector<Signal> object{
      {"command", 0, 8, false, 0, ""}, {"index", 8, 16, false, 0, ""}, {"sub_index", 24, 8, false, 0, ""}};
  return {
      {"emergency",
       CobId::emergency,
       8,
       true,
       {{"error_code", 0, 16, false, 0, ""}, {"error_register", 16, 8, false, 0, ""}, {"fault", 24, 8, false, 0, ""}}},
      {"heartbeat", CobId::heartbeat, 1, true, {{"state", 0, 8, false, 0, ""}}},
      {"sdo_answer", CobId::sdo_answer, 8, true, object},
      {"sdo_request", CobId::sdo_request, 8, false, object}};
}

// A DBC file as it grows.
struct Writer {
  std::string text{};
  std::vector<std::uint32_t> fd_ids{}, mode_ids{};

  void message(std::uint32_t id, const std::string& name, std::size_t size, const std::string& sender, Format format) {
    if (format == Format::fd) fd_ids.push_back(id);
    text += "\nBO_ " + std::to_string(id) + " " + name + ": " + std::to_string(size) + " " + sender + "\n";
  }

  void add_nodes(const DbcBus& bus) {
    const auto sizes = properties(bus.format).sizes;
    message(sync_id, "sync", sizes[0], "drive", bus.format);
    text +=
        " SG_ tick : 0|32@1+ (1,0) [0|0] \"\" Vector__XXX\n"
        " SG_ checksum : 48|16@1+ (1,0) [0|0] \"\" Vector__XXX\n";
    for (const auto& axis : bus.axes)
      for (const auto& m : messages(bus.format)) {
        message(m.id + static_cast<std::uint32_t>(axis.node), axis.name + "_" + m.name, sizes[m.size_index],
                m.of_drive ? "drive" : axis.name, bus.format);
        for (const auto& signal : m.signals) text += line_of(signal, m.of_drive ? axis.name : "drive");
      }
  }

  void add_server(const DbcBus& bus, double increment) {
    for (const auto& axis : bus.axes)
      for (const auto& m : server_messages(increment)) {
        const auto& pdo = description_of(m.pdo);
        if (!pdo.exchanged_at(bus.level)) continue;
        if (m.pdo == Pdo::mode) mode_ids.push_back(pdo.id() + static_cast<std::uint32_t>(axis.node));
        message(pdo.id() + static_cast<std::uint32_t>(axis.node), axis.name + "_" + m.name, pdo.size,
                pdo.received ? "controller" : "drive", bus.format);
        for (const auto& signal : m.signals) text += line_of(signal, pdo.received ? "drive" : "controller");
      }
  }

  // Classical frames on every bus.
  void add_network(const DbcBus& bus) {
    if (bus.axes.empty()) return;
    message(base_of(CobId::network), "network", 2, "controller", Format::classical);
    text += line_of({"command", 0, 8, false, 0, ""}, "drive") + line_of({"node", 8, 8, false, 0, ""}, "drive");
    for (const auto& axis : bus.axes)
      for (const auto& m : network_messages()) {
        message(id_of(m.use, axis.node), axis.name + "_" + m.name, m.size, m.of_drive ? "drive" : "controller",
                Format::classical);
        for (const auto& signal : m.signals) text += line_of(signal, m.of_drive ? "controller" : "drive");
      }
  }

  // What the numbers of 6060h are; those below 0 are the manufacturer's.
  void add_modes() {
    for (const auto id : mode_ids)
      text += "\nVAL_ " + std::to_string(id) +
              " mode_of_operation -2 \"gear\" -1 \"cam\" 1 \"profile position\" 3 \"profile velocity\" 6 \"homing\" 8 "
              "\"cyclic position\" 9 \"cyclic velocity\" 10 \"cyclic torque\";\n";
  }

  void add_formats() {
    if (fd_ids.empty()) return;
    text +=
        "\nBA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\"reserved\",\"reserved\",\"reserved\","
        "\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\","
        "\"reserved\",\"StandardCAN_FD\",\"ExtendedCAN_FD\";\nBA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n";
    for (const auto id : fd_ids) text += "BA_ \"VFrameFormat\" BO_ " + std::to_string(id) + " 14;\n";
  }
};

}  // namespace

std::string dbc_text(const DbcBus& nodes, const DbcBus& server, double increment) {
  Writer writer{"VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: drive"};
  for (const auto& axis : nodes.axes) writer.text += " " + axis.name;
  writer.text += server.axes.empty() ? "\n" : " controller\n";
  if (!nodes.axes.empty())
    writer.add_nodes(nodes);
  else
    writer.message(sync_id, "sync", 0, "drive", server.format);
  writer.add_server(server, increment);
  writer.add_network(server);
  writer.add_formats();
  writer.add_modes();
  return writer.text;
}

}  // namespace stiction::hal::can
