#include "hal/can/dbc.hpp"

#include <cmath>
#include <cstdio>
#include <vector>

namespace stiction::hal::can {
namespace {

struct Signal {
  const char* name;
  int first_bit;
  int bits;
  bool is_signed;
  int fraction_bits;  // the value is raw * 2^-fraction_bits
  const char* unit;
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
  for (const char* name : {"valid", "fault", "limit_negative", "limit_positive", "home", "index_passed"})
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
            counter,
            checksum}}};
}

std::string line_of(const Signal& s, const std::string& receiver) {
  char text[160];
  std::snprintf(text, sizeof text, " SG_ %s : %d|%d@1%c (%.17g,0) [0|0] \"%s\" %s\n", s.name, s.first_bit, s.bits,
                s.is_signed ? '-' : '+', std::ldexp(1.0, -s.fraction_bits), s.unit, receiver.c_str());
  return text;
}

}  // namespace

std::string dbc_text(Format format, std::span<const DbcAxis> axes) {
  std::string text = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: drive";
  for (const auto& axis : axes) text += " " + axis.name;
  const auto sizes = properties(format).sizes;
  text += "\n\nBO_ " + std::to_string(sync_id) + " sync: " + std::to_string(sizes[0]) +
          " drive\n SG_ tick : 0|32@1+ (1,0) [0|0] \"\" Vector__XXX\n"
          " SG_ checksum : 48|16@1+ (1,0) [0|0] \"\" Vector__XXX\n";
  std::vector<std::uint32_t> ids{sync_id};
  for (const auto& axis : axes)
    for (const auto& message : messages(format)) {
      const std::uint32_t id = message.id + static_cast<std::uint32_t>(axis.node);
      ids.push_back(id);
      text += "\nBO_ " + std::to_string(id) + " " + axis.name + "_" + message.name + ": " +
              std::to_string(sizes[message.size_index]) + " " + (message.of_drive ? "drive" : axis.name) + "\n";
      for (const auto& signal : message.signals) text += line_of(signal, message.of_drive ? axis.name : "drive");
    }
  if (format == Format::fd) {
    text +=
        "\nBA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\"reserved\",\"reserved\",\"reserved\","
        "\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\",\"reserved\","
        "\"reserved\",\"StandardCAN_FD\",\"ExtendedCAN_FD\";\nBA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN_FD\";\n";
    for (const auto id : ids) text += "BA_ \"VFrameFormat\" BO_ " + std::to_string(id) + " 14;\n";
  }
  return text;
}

}  // namespace stiction::hal::can
