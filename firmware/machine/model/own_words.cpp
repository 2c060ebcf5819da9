#include "firmware/machine/model/own_words.hpp"

#include <array>
#include <cstddef>

namespace stiction::machine {
namespace {

// Phrases before the words that they contain.
constexpr std::array word_pairs{
    SpelledPair{"weight of the load, towards -x; of a rotary axis its moment about the rest below",
                "moment of the load's weight about the rest below"},
    SpelledPair{"force against the weight", "moment against that of the weight"},
    SpelledPair{"pole-pair pitch tau_p", "number of pole pairs"},
    SpelledPair{"force constant K_F", "torque constant K_T"},
    SpelledPair{"1 m/s", "1 rad/s"},
    SpelledPair{"forces", "torques"},
    SpelledPair{"force", "torque"},
    SpelledPair{"mass", "inertia"},
    SpelledPair{"way", "angle"},
};

bool is_of_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

// Whether `text` has `word` at `at`, and not within a longer word.
bool has_word(std::string_view text, std::size_t at, std::string_view word) {
  if (text.substr(at, word.size()) != word) return false;
  const std::size_t end = at + word.size();
  return (at == 0 || !is_of_word(text[at - 1])) && (end == text.size() || !is_of_word(text[end]));
}

}  // namespace

std::string in_own_words(std::string_view text, const Coordinate& coordinate) {
  if (!coordinate.rotary()) return std::string(text);
  std::string own;
  for (std::size_t at = 0; at < text.size();) {
    const SpelledPair* found = nullptr;
    for (const auto& pair : word_pairs)
      if (found == nullptr && has_word(text, at, pair.linear)) found = &pair;
    if (found == nullptr) {
      own += text[at++];
      continue;
    }
    own += found->rotary;
    at += found->linear.size();
  }
  return own;
}

}  // namespace stiction::machine
