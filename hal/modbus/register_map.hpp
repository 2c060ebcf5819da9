// What a Modbus slave shows: registers with their types, scales and who may write them, and the words that values
// become. Values of 32 bits take two registers, the high word first (ABCD), as most drives have it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace stiction::hal {

enum class RegisterTable : std::uint8_t { input, holding };  // functions 4; 3, 6, 16, 23
enum class RegisterType : std::uint8_t { uint16, int16, uint32, int32, float32 };
enum class RegisterAccess : std::uint8_t {
  read,
  write,
  motion,  // moves an axis: written only where motion over this server is allowed
};

struct Register {
  RegisterTable table = RegisterTable::input;
  std::uint16_t address = 0;  // of the first word, counted from 0 as on the wire
  RegisterType type = RegisterType::uint16;
  RegisterAccess access = RegisterAccess::read;
  std::string name;
  std::string unit;    // of the value; "1": none
  double scale = 1.0;  // value = raw number * scale
  std::string text;
  // Values that may be written; `low_open` excludes the lower end.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  std::vector<double> choices;  // empty: every value of the range
};

const char* name_of(RegisterType type);
int words_of(RegisterType type);

// A value that a client wrote, for who acts upon it.
struct RegisterWrite {
  std::size_t index = 0;  // in RegisterMap::registers()
  double value = 0.0;
};

// The exceptions of the protocol that a map answers with.
enum class ModbusException : std::uint8_t {
  illegal_function = 1,  // the register moves an axis, and that is not allowed
  illegal_address = 2,   // there is no such register, or it is not for writing
  illegal_value = 3,     // out of range, not a number, or half of a 32-bit value
  device_failure = 4,    // what was asked failed, or the control loop makes no progress
  busy = 6,              // earlier writes have not been taken yet, or parameters come too fast
};

class RegisterMap {
 public:
  // Throws std::invalid_argument where registers overlap or end beyond 65535.
  explicit RegisterMap(std::vector<Register> registers);

  std::span<const Register> registers() const { return registers_; }
  // Words from address 0 on, with zeros between registers.
  std::size_t size(RegisterTable table) const { return sizes_[static_cast<std::size_t>(table)]; }

  // One value a register in their order, as words of both tables. What a type cannot hold becomes its nearest value; a
  // value that is not a number becomes 0 in an integer. `values`: as many as registers(); `input`, `holding`: of the
  // size() of their table.
  void encode(std::span<const double> values, std::span<std::uint16_t> input, std::span<std::uint16_t> holding) const;

  // All values that words written from `address` on mean, or why none of them is taken. `words`: as received;
  // `motion_allowed`: registers that move an axis may be written.
  std::variant<std::vector<RegisterWrite>, ModbusException> writes_of(std::size_t address,
                                                                      std::span<const std::uint16_t> words,
                                                                      bool motion_allowed) const;

 private:
  std::vector<Register> registers_;
  std::size_t sizes_[2] = {0, 0};
  std::vector<std::size_t> holding_;  // by address: index of the register plus 1; 0: none
};

// Two words of a value, for other uses of the same layout. `type`: of the register; `raw`: its value in register units;
// `words`: words_of(`type`) of them, written.
void put_words(RegisterType type, double raw, std::span<std::uint16_t> words);
double number_in(RegisterType type, std::span<const std::uint16_t> words);

// The registers as a table of Markdown.
std::string register_table(std::span<const Register> registers);

}  // namespace stiction::hal
