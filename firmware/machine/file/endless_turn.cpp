#include "firmware/machine/file/endless_turn.hpp"

#include <fmt/format.h>

#include <optional>

#include "firmware/machine/file/exact_value.hpp"
#include "stiction/motion/endless_phase.hpp"

namespace stiction::machine {
namespace {

class EndlessTurn {
 public:
  EndlessTurn(const Document& document, const toml::table& table, const std::string& path, const AxisModel& axis)
      : document_(document), table_(table), path_(path), axis_(axis), base_(axis.coordinate.rotary() ? "rad" : "m") {}

  Fraction modulo() const { return quantity("modulo"); }

  // In one `modulo`; none where the increment is no exact part of it.
  std::optional<Fraction> counts(const Fraction& modulo) const {
    const auto& encoder = axis_.encoder;
    std::optional<Fraction> counts;
    if (encoder.increment == 0.0) return counts;
    if (!encoder.counts) {
      const auto increment = exact_quantity(*node("encoder.increment"), base_);
      if (!increment && encoder.on == EncoderPlace::motor) return counts;
      counts = quotient(modulo, increment ? *increment : quantity("encoder.increment"));
    } else if (const auto turns = encoder.on == EncoderPlace::motor ? motor_turns(modulo) : modulo) {
      counts = product(*turns, number("encoder.counts"));
    }
    if (!counts || !EndlessPhase::can_keep(counts->numerator, counts->denominator)) refuse_size(counts);
    if (encoder.on == EncoderPlace::load && counts->denominator != 1) refuse_part(*counts);
    return counts;
  }

 private:
  const toml::node* node(std::string_view key) const { return table_.at_path(key).node(); }

  std::string at_line(std::string_view key) const {
    const toml::node& found = *node(key);
    return fmt::format("{}, {} (line {})", key, describe_node(found), found.source().begin.line);
  }

  std::optional<Fraction> motor_turns(const Fraction& modulo) const {
    auto turns = std::optional(modulo);
    if (!axis_.transmission) return turns;
    const auto& transmission = *axis_.transmission;
    if (transmission.lead) turns = quotient(modulo, length("transmission.lead"));
    if (transmission.pulley_circumference) turns = quotient(modulo, length("transmission.pulley_circumference"));
    if (!turns || node("transmission.ratio") == nullptr) return turns;
    return product(*turns, number("transmission.ratio"));
  }

  Fraction number(const char* key) const {
    if (const auto value = exact_number(*node(key))) return *value;
    fail(key, fmt::format("a number of at most 15 digits or a fraction such as \"355/113\", neither number of which is "
                          "above {}: the turns of an endless axis are counted exactly",
                          largest_in_file_words));
  }
  Fraction quantity(const char* key) const { return of(key, base_); }
  Fraction length(const char* key) const { return of(key, "m"); }

  Fraction of(const char* key, std::string_view base) const {
    if (const auto value = exact_quantity(*node(key), base)) return *value;
    fail(key, base == "rad" ? "an angle of at most 15 digits in deg, arcmin, arcsec or rev, of which a turn is a whole "
                              "number: the turns of an endless axis are counted exactly, and a turn has no exact "
                              "number of radians"
                            : "a length of at most 15 digits: the turns of an endless axis are counted exactly");
  }

  // What is in a turn, and the keys that make it.
  std::string made_by() const {
    std::string keys;
    for (const char* key : {"transmission.ratio", "transmission.lead", "transmission.pulley_circumference",
                            "encoder.counts", "encoder.increment"})
      if (node(key) != nullptr) keys += fmt::format("{}{}", keys.empty() ? "" : " and ", at_line(key));
    return keys;
  }

  [[noreturn]] void refuse_size(const std::optional<Fraction>& counts) const {
    const auto found =
        counts ? fmt::format("{} counts", text_of(*counts)) : std::string("a fraction of more than 64 bits");
    fail("modulo", fmt::format("at least one count and a numerator of at most 2^62 in the counts of a turn, {} by {}",
                               found, made_by()));
  }

  // What an encoder on the load counts in one round must be whole, or the rounds drift apart.
  [[noreturn]] void refuse_part(const Fraction& counts) const {
    document_.fail(node("modulo")->source(), join_key(path_, "modulo"),
                   fmt::format("{}, {:.6g} increments by {}", describe_node(*node("modulo")),
                               static_cast<double>(counts.numerator) / static_cast<double>(counts.denominator),
                               at_line(axis_.encoder.counts ? "encoder.counts" : "encoder.increment")),
                   "a whole number of increments: an encoder on the load is where it was after each round");
  }

  [[noreturn]] void fail(const char* key, const std::string& expected) const {
    document_.fail(node(key)->source(), join_key(path_, key), describe_node(*node(key)), expected);
  }

  const Document& document_;
  const toml::table& table_;
  const std::string& path_;
  const AxisModel& axis_;
  std::string_view base_;  // of its lengths or angles
};

}  // namespace

void keep_exactly(const Document& document, const toml::table& table, const std::string& path, AxisModel& axis) {
  if (axis.transmission) {
    const toml::node* ratio = table.at_path("transmission.ratio").node();
    axis.transmission->exact_ratio = ratio == nullptr ? Fraction{1, 1} : exact_number(*ratio);
  }
  if (!axis.modulo) return;
  const EndlessTurn turn(document, table, path, axis);
  axis.exact_modulo = turn.modulo();
  axis.modulo_counts = turn.counts(*axis.exact_modulo);
}

}  // namespace stiction::machine
