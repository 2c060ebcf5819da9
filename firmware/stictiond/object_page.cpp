// The objects as a page for people and as an electronic data sheet for a master's tools (CiA 306).
#include <fmt/format.h>

#include <array>
#include <vector>

#include "firmware/stictiond/modbus_registers.hpp"
#include "firmware/stictiond/objects.hpp"
#include "hal/can/identifiers.hpp"

namespace stiction::drive {
namespace {

constexpr std::array<const char*, 3> access_names{"const", "ro", "rw"};
constexpr std::array<const char*, 11> unit_names{"–",
                                                 "increments",
                                                 "1000 increments/s",
                                                 "1000 increments/s²",
                                                 "thousandths of the current limit",
                                                 "ms",
                                                 "thousandths",
                                                 "tenths of the register's unit",
                                                 "hundredths of the register's unit",
                                                 "millionths",
                                                 "billionths"};

std::string meaning_of(const Object& object) {
  switch (object.source) {
    case ObjectSource::number:
      return object.number < 10.0 ? fmt::format("{:.0f}", object.number)
                                  : fmt::format("{:X}h", static_cast<std::uint32_t>(object.number));
    case ObjectSource::node_id:
      return fmt::format("{:x}h + node", static_cast<std::uint32_t>(object.number));
    case ObjectSource::text: {
      const std::string_view of = object.of;
      return of == "machine"   ? "id of the machine file"
             : of == "version" ? "as `stictiond --version`"
                               : "\"" + std::string(of) + "\"";
    }
    case ObjectSource::state:
    case ObjectSource::command:
      return fmt::format("register `{}`", source_name(object, "NAME"));
    case ObjectSource::parameter:
    case ObjectSource::setup:
      return fmt::format("key `{}`", source_name(object, "NAME"));
    case ObjectSource::node:
      break;
  }
  switch (object.index) {
    case 0x1001:
      return "bit 0: a fault; bit 1: current, 2: voltage, 3: temperature, 4: communication, 5: of the profile, 7: of "
             "the manufacturer";
    case 0x1003:
      return object.sub == 0 ? "errors since the start or since 0 was written, at most 8"
                             : "bits 0 to 15: error code, bits 16 to 31: number of the fault; 1 is the newest";
    case 0x1010:
      return "writing 65766173h (\"save\") stores the written parameters for the next start";
    case 0x1016:
      return "bits 16 to 22: node, bits 0 to 15: ms without its heartbeat after which the commander is lost; 0: it is "
             "not watched";
    default:
      return "ms from one heartbeat to the next; 0: none";
  }
}

std::string address_of(const Object& object, bool with_sub) {
  return with_sub ? fmt::format("{:04X}sub{:X}", object.index, object.sub) : fmt::format("{:04X}", object.index);
}

std::string default_of(const Object& object) {
  if (object.source == ObjectSource::node_id)
    return fmt::format("$NODEID+0x{:X}", static_cast<std::uint32_t>(object.number));
  if (object.source == ObjectSource::number) return fmt::format("0x{:X}", static_cast<std::uint32_t>(object.number));
  if (object.source == ObjectSource::text && std::string_view(object.of) == "stiction") return object.of;
  return "";
}

void add_object(std::string& text, const Object& object, bool with_sub) {
  text += fmt::format(
      "[{}]\nParameterName={}\nObjectType=0x7\nDataType=0x{:04X}\nAccessType={}\nDefaultValue={}\nPDOMapping=0\n\n",
      address_of(object, with_sub), object.name, row_of(object.type).code,
      access_names[static_cast<std::size_t>(object.access)], default_of(object));
}

std::size_t subs_of(std::uint16_t index) {
  std::size_t count = 0;
  for (const Object& object : object_table())
    if (object.index == index) ++count;
  return count;
}

void add_list(std::string& text, const char* title, const std::vector<std::uint16_t>& indices) {
  text += fmt::format("[{}]\nSupportedObjects={}\n", title, indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) text += fmt::format("{}=0x{:04X}\n", i + 1, indices[i]);
  text += "\n";
}

}  // namespace

std::string object_page() {
  std::string identifiers = "| identifier | from | carries |\n| --- | --- | --- |\n";
  for (const auto& row : hal::can::identifier_table)
    identifiers += fmt::format("| {:03x}h{} | {} | {} |\n", row.base, row.of_node ? " + node" : "",
                               row.to_drive && row.of_drive ? "both"
                               : row.to_drive               ? "the other side"
                                                            : "drive",
                               row.text);
  std::string objects = "| object | type | access | name | value in | value |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const Object& object : object_table())
    objects += fmt::format("| {:04X}h{} | {} | {} | {} | {} | {} |\n", object.index,
                           subs_of(object.index) > 1 ? fmt::format(", {}", object.sub) : "", row_of(object.type).name,
                           access_names[static_cast<std::size_t>(object.access)], object.name,
                           unit_names[static_cast<std::size_t>(object.unit)], meaning_of(object));
  return "# CANopen: the drive's objects\n\n"
         "Each axis of `[drive.can_server]` is a node (`server_node`). `stictiond --eds` prints the electronic data "
         "sheet of a node. Values come from the [registers](modbus_registers.md) of the axis and from keys of its "
         "machine file; NAME is the axis. An increment is `position_increment`.\n\n"
         "SDO transfers are expedited or segmented, one at a time on each node; a transfer that its client leaves for "
         "a second is aborted (0504 0000h). A command needs `motion = \"allowed\"`, and an axis that CAN commands or "
         "that "
         "has no owner; a stop is taken from every client. In csp, csv and cst an axis wants its frames each cycle. "
         "Parameters are refused (0800 0021h) until the operator of the drive's computer opens the commissioning "
         "window "
         "(SIGUSR1), a limit is only made tighter than it is (0609 0030h), and a written value holds from the next "
         "start "
         "on, if it is stored (1010h). The log says which parameter, limit and value were refused. A parameter that "
         "the "
         "machine file leaves out has no value (0800 0024h), but for 6065h, which shows the limit in force.\n\n"
         "## Objects\n\n" +
         objects + "\n## Identifiers\n\n" + identifiers;
}

std::string eds_text() {
  std::string text =
      "[FileInfo]\nFileName=stiction.eds\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n"
      "Description=Axis of a stiction drive\n\n"
      "[DeviceInfo]\nVendorName=stiction\nVendorNumber=0x0\nProductName=stiction\n";
  text += fmt::format("ProductNumber=0x{:X}\nRevisionNumber=0x1\n", modbus_identification);
  for (const int kilobits : {10, 20, 50, 125, 250, 500, 800, 1000}) text += fmt::format("BaudRate_{}=1\n", kilobits);
  text +=
      "SimpleBootUpMaster=0\nSimpleBootUpSlave=1\nGranularity=0\nDynamicChannelsSupported=0\nGroupMessaging=0\n"
      "NrOfRXPDO=0\nNrOfTXPDO=0\nLSS_Supported=0\n\n";
  std::vector<std::uint16_t> mandatory, optional, manufacturer;
  for (const Object& object : object_table()) {
    if (object.sub != 0) continue;
    const bool needed = object.index == 0x1000 || object.index == 0x1001 || object.index == 0x1018;
    const bool own = object.index >= 0x2000 && object.index < 0x6000;
    (needed ? mandatory : own ? manufacturer : optional).push_back(object.index);
  }
  add_list(text, "MandatoryObjects", mandatory);
  add_list(text, "OptionalObjects", optional);
  add_list(text, "ManufacturerObjects", manufacturer);
  for (const Object& object : object_table()) {
    const std::size_t subs = subs_of(object.index);
    if (subs > 1 && object.sub == 0) {
      const bool array = object.index == 0x1003 || object.index == 0x1010 || object.index == 0x1016 ||
                         object.index == 0x2301 || object.index == 0x2302 || object.index == 0x607d ||
                         object.index == 0x6099;
      text += fmt::format("[{:04X}]\nParameterName={}\nObjectType=0x{}\nSubNumber={}\n\n", object.index,
                          record_name(object.index), array ? 8 : 9, subs);
    }
    add_object(text, object, subs > 1);
  }
  return text;
}

}  // namespace stiction::drive
