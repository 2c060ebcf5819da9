#include "hal/modbus/register_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace stiction::hal {
namespace {

struct TypeRow {
  const char* name;
  int words;
  double low, high;  // of the raw number
};
constexpr std::array<TypeRow, 5> types{{
    {"uint16", 1, 0.0, 65535.0},
    {"int16", 1, -32768.0, 32767.0},
    {"uint32", 2, 0.0, 4294967295.0},
    {"int32", 2, -2147483648.0, 2147483647.0},
    {"float32", 2, -std::numeric_limits<float>::max(), std::numeric_limits<float>::max()},
}};
const TypeRow& row_of(RegisterType type) { return types[static_cast<std::size_t>(type)]; }

constexpr std::array<const char*, 3> access_names{"read", "write", "motion"};

}  // namespace

const char* name_of(RegisterType type) { return row_of(type).name; }
int words_of(RegisterType type) { return row_of(type).words; }

void put_words(RegisterType type, double raw, std::span<std::uint16_t> words) {
  const TypeRow& row = row_of(type);
  std::uint32_t bits = 0;
  if (type == RegisterType::float32) {
    const double held = std::isfinite(raw) ? std::clamp(raw, row.low, row.high) : raw;
    bits = std::bit_cast<std::uint32_t>(static_cast<float>(held));
  } else if (!std::isnan(raw)) {
    bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::clamp(std::round(raw), row.low, row.high)));
  }
  if (row.words == 2) words[0] = static_cast<std::uint16_t>(bits >> 16);
  words[row.words - 1] = static_cast<std::uint16_t>(bits);
}

double number_in(RegisterType type, std::span<const std::uint16_t> words) {
  const std::uint32_t bits =
      row_of(type).words == 2 ? (std::uint32_t{words[0]} << 16) | words[1] : std::uint32_t{words[0]};
  switch (type) {
    case RegisterType::float32:
      return std::bit_cast<float>(bits);
    case RegisterType::int32:
      return static_cast<std::int32_t>(bits);
    case RegisterType::int16:
      return static_cast<std::int16_t>(bits);
    default:
      return bits;
  }
}

RegisterMap::RegisterMap(std::vector<Register> registers) : registers_(std::move(registers)) {
  std::array<std::vector<std::size_t>, 2> owner;
  for (std::size_t i = 0; i < registers_.size(); ++i) {
    const Register& r = registers_[i];
    auto& used = owner[static_cast<std::size_t>(r.table)];
    const std::size_t end = std::size_t{r.address} + static_cast<std::size_t>(words_of(r.type));
    if (end > 65536) throw std::invalid_argument(fmt::format("register {} ends beyond 65535", r.name));
    if (used.size() < end) used.resize(end);
    for (std::size_t a = r.address; a < end; ++a) {
      if (used[a] != 0)
        throw std::invalid_argument(
            fmt::format("register {} at {} overlaps {}", r.name, r.address, registers_[used[a] - 1].name));
      used[a] = i + 1;
    }
  }
  sizes_[0] = owner[0].size();
  sizes_[1] = owner[1].size();
  holding_ = std::move(owner[1]);
}

void RegisterMap::encode(std::span<const double> values, std::span<std::uint16_t> input,
                         std::span<std::uint16_t> holding) const {
  for (std::size_t i = 0; i < registers_.size(); ++i) {
    const Register& r = registers_[i];
    put_words(r.type, values[i] / r.scale, (r.table == RegisterTable::input ? input : holding).subspan(r.address));
  }
}

std::variant<std::vector<RegisterWrite>, ModbusException> RegisterMap::writes_of(std::size_t address,
                                                                                 std::span<const std::uint16_t> words,
                                                                                 bool motion_allowed) const {
  std::vector<RegisterWrite> writes;
  while (!words.empty()) {
    if (address >= holding_.size() || holding_[address] == 0) return ModbusException::illegal_address;
    const std::size_t index = holding_[address] - 1;
    const Register& r = registers_[index];
    const auto length = static_cast<std::size_t>(words_of(r.type));
    if (r.access == RegisterAccess::read) return ModbusException::illegal_address;
    if (r.access == RegisterAccess::motion && !motion_allowed) return ModbusException::illegal_function;
    if (r.address != address || words.size() < length) return ModbusException::illegal_value;
    const double value = number_in(r.type, words) * r.scale;
    const bool above = r.low_open ? value > r.low : value >= r.low;
    if (!std::isfinite(value) || !above || value > r.high) return ModbusException::illegal_value;
    if (!r.choices.empty() && std::find(r.choices.begin(), r.choices.end(), value) == r.choices.end())
      return ModbusException::illegal_value;
    writes.push_back({index, value});
    address += length;
    words = words.subspan(length);
  }
  return writes;
}

std::string register_table(std::span<const Register> registers) {
  std::string table =
      "| address | type | access | name | value in | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const Register& r : registers) {
    std::string unit = r.unit == "1" ? "–" : r.unit;
    if (r.scale != 1.0) unit = fmt::format("{:g} {}", r.scale, r.unit);
    table += fmt::format("| {} | {} | {} | `{}` | {} | {} |\n", r.address, name_of(r.type),
                         access_names[static_cast<std::size_t>(r.access)], r.name, unit, r.text);
  }
  return table;
}

}  // namespace stiction::hal
