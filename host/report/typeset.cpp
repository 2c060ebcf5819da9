// Plain text as a page prints it: see typeset.hpp.
#include "host/report/typeset.hpp"

#include <array>
#include <cctype>
#include <utility>

#include "host/report/circle_finding.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 2> spellings{{{"+-", "±"}, {"^2", "²"}}};

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || (c & 0x80); }

bool is_word(std::string_view text, std::size_t at, std::string_view word) {
  const std::size_t end = at + word.size();
  return text.substr(at, word.size()) == word && (at == 0 || !in_word(text[at - 1])) &&
         (end == text.size() || !in_word(text[end]));
}

std::string spelled(std::string_view text) {
  if (text == "us") return "µs";
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    std::string_view from = text.substr(at, 1), to = from;
    if (is_word(text, at, "um")) from = "um", to = "µm";
    if (is_word(text, at, "urad")) from = "urad", to = "µrad";
    for (const auto& [plain, spelling] : spellings)
      if (text.substr(at, plain.size()) == plain) from = plain, to = spelling;
    out += to;
    at += from.size();
  }
  return out;
}

}  // namespace

NamedModel split_model(std::string_view text) {
  NamedModel split{"", std::string(text)};
  for (const auto& law : sim::friction_tables()) {
    const std::string name(law.name);
    if (text == name) split = {name, ""};
    if (text.starts_with(name + ", ")) split = {name, std::string(text.substr(name.size() + 2))};
    if (text.ends_with(", " + name)) split = {name, std::string(text.substr(0, text.size() - name.size() - 2))};
  }
  return split;
}

std::string typeset(std::string_view text) {
  std::string labelled(text);
  for (const auto& law : sim::friction_tables()) {
    const std::string name(law.name);
    const auto label = friction_label(name);
    if (text == name || text.starts_with(name + ":") || text.starts_with(name + ","))
      labelled = label + std::string(text.substr(name.size()));
    else if (text.ends_with(", " + name))
      labelled = std::string(text.substr(0, text.size() - name.size())) + label;
  }
  return spelled(labelled);
}

}  // namespace stiction::host
