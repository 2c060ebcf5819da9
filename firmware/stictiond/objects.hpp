// The objects that a node of CANopen has (CiA 301, CiA 402; IEC 61800-7-201): one table, from which the server, the
// page docs/canopen_objects.md and the EDS file come. An object has no value of its own: it reads a register of
// modbus_registers.hpp, a parameter of the machine file, or what the node knows of itself.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "firmware/stictiond/configuration.hpp"

namespace stiction::drive {

enum class ObjectType : std::uint8_t { integer8, integer16, integer32, unsigned8, unsigned16, unsigned32, text };
struct ObjectTypeRow {
  const char* name;
  std::size_t bytes;   // 0: as many as the text has
  std::uint16_t code;  // of the object dictionary (CiA 301, 7.4.7.1)
  double low, high;
};
const ObjectTypeRow& row_of(ObjectType type);

enum class ObjectAccess : std::uint8_t { constant, read, write };  // "const", "ro", "rw"

// What a unit of the object is.
enum class ObjectUnit : std::uint8_t {
  none,
  position,      // an increment of the bus
  speed,         // 1000 increments a second
  acceleration,  // 1000 increments a second squared
  torque,        // a thousandth of the current limit
  millisecond,
  thousandth,
  tenth,      // of the register's unit
  hundredth,  // of the register's unit
  millionth,  // of a cycle, of a second, of one
  billionth,  // of a metre
};
// SI value of one. `increment`: of position on the bus, m.
double value_of(ObjectUnit unit, double increment);

// Where the value comes from.
enum class ObjectSource : std::uint8_t {
  number,     // the table
  node_id,    // the table's number plus the node
  text,       // the table's, or the programme's
  state,      // an input register of the axis
  command,    // a holding register of the axis that moves it
  parameter,  // a key of the axis in the machine file; AXIS is for its name; left out there: of the configuration
  setup,      // the configuration, which no bus writes
  node,       // what the node knows of itself (object_server.cpp)
};

struct Object {
  std::uint16_t index;
  std::uint8_t sub;
  ObjectType type;
  ObjectAccess access;
  const char* name;
  ObjectUnit unit = ObjectUnit::none;
  ObjectSource source = ObjectSource::node;
  const char* of = "";  // register, key or text
  double number = 0.0;
  double (*setup)(const DriveConfiguration&, std::size_t axis) = nullptr;
};

// In the order of their addresses. Objects with sub-indices have their number at sub-index 0.
std::span<const Object> object_table();
// Null: there is none. `index`, `sub`: its address.
const Object* object_at(std::uint16_t index, std::uint8_t sub);
bool has_index(std::uint16_t index);
// The name of the whole of an object with sub-indices.
const char* record_name(std::uint16_t index);

// Name of the register or key of an axis. `axis`: its name.
std::string source_name(const Object& object, const std::string& axis);

// A page of Markdown, and an electronic data sheet (CiA 306).
std::string object_page();
std::string eds_text();

}  // namespace stiction::drive
