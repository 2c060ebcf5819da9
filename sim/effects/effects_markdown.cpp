#include "sim/effects/effects_markdown.hpp"

#include <fmt/format.h>

#include "sim/effects/effects.hpp"

namespace stiction::sim {
namespace {

std::string link_to(EffectId effect) { return fmt::format("[{}](../{}/page.md)", effect->name, effect->folder); }

std::string keys_text(EffectId effect) {
  std::string text;
  for (const machine::ValueKey& key : effect->keys) {
    text += fmt::format("{}`{}`{}", text.empty() ? "" : ", ", key.key, key.list ? " [..]" : "");
    if (key.unit != "1") text += fmt::format(" ({})", key.unit);
  }
  return text;
}

}  // namespace

std::string effects_markdown() {
  std::string effects = "| effect | what the simulation lacks or has wrong | keys |\n| --- | --- | --- |\n";
  std::string pairs = "| effect | may be | what separates them |\n| --- | --- | --- |\n";
  for (const EffectId effect : all_effects()) {
    effects += fmt::format("| {} | {} | {} |\n", link_to(effect), effect->text, keys_text(effect));
    for (const Confusion& confusion : confusions_of(effect))
      if (effect < confusion.other)
        pairs += fmt::format("| {} | {} | {} |\n", effect->name, confusion.other->name, confusion.separate_by);
  }
  return effects + "\n" + pairs;
}

}  // namespace stiction::sim
