// The registers as a page for people.
#include <fmt/format.h>

#include <vector>

#include "firmware/stictiond/modbus_registers.hpp"

namespace stiction::drive {

std::string modbus_register_page() {
  machine::Machine machine;
  machine.axes.emplace_back().name = "NAME";
  const ModbusRegisters registers(machine, {});
  std::vector<hal::Register> input, holding;
  for (const hal::Register& r : registers.map().registers())
    (r.table == hal::RegisterTable::input ? input : holding).push_back(r);
  return fmt::format(
      "# Modbus: the drive's registers\n\n"
      "Version {} (input registers 0 and 1 hold 21316 and {}). Addresses count from 0 as on the wire. Values of 32 "
      "bits take two registers, the high word first (ABCD), and must be written together. The tables list the "
      "registers of the drive and of its first axis. For each further axis, in the order of the machine file, add {} "
      "to the addresses of state and commands and {} to those of parameters.\n\n"
      "A write request is refused with exception 1 if a register moves an axis and `[drive.modbus_server] motion` is "
      "not `\"allowed\"` or the programme moves the axes itself (`--circle`, `--hold`) and the write is no stop, 2 if "
      "there is no such register or it is read-only, 3 if a value is out of range or half of a "
      "32-bit value, 4 if the control loop makes no progress or parameters could not be stored, 6 if parameters come "
      "faster than 50 a second after the first 256 or a different source commands the axis (input register owner) and "
      "the write is no stop. A refused request writes nothing. Commands that move an axis are "
      "never refused because of other writes; of several values for one register the loop takes the newest, "
      "and "
      "a controlword that stops an axis before those that follow it. An axis belongs to the source that leads it to "
      "ready "
      "to switch on, until this one disables the voltage or is lost (`commander_timeout`). A stop is taken from every "
      "source; one of a source that is not the owner holds the axis until the same source writes 15. Positions are "
      "those of the machine, counted from the zero that homing found.\n\n"
      "## Input registers (function 4)\n\n"
      "{}\n"
      "## Holding registers (functions 3, 6, 16, 23)\n\n"
      "Parameters and `store_parameters` are refused with exception 1 until the operator of the drive's computer opens "
      "the "
      "commissioning window (SIGUSR1), which closes by itself after `commissioning_time`. A limit is only made tighter "
      "than it is (exception 3). The log says which parameter, limit and value were refused. A parameter that the "
      "machine file leaves out reads as not-a-number. A written value can be read back at once, is stored by "
      "`store_parameters`, whose answer comes when it is on the disk, and takes effect at the next start. Before it is "
      "stored everything that a start would build is built of the set; where that is refused (exception 4, "
      "`store_result`) the values that were written since the last set are dropped.\n\n"
      "{}",
      modbus_schema, modbus_schema, axis_registers, parameter_registers, hal::register_table(input),
      hal::register_table(holding));
}

}  // namespace stiction::drive
