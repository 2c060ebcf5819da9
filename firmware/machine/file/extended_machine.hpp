// The text of a machine file with effects added: what diagnosis leaves behind.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "firmware/machine/file/edited_machine.hpp"
#include "firmware/machine/model/coordinate.hpp"
#include "firmware/machine/model/effect.hpp"

namespace stiction::machine {

struct AxisEffects {
  std::string axis;
  std::vector<Effect> effects;  // without a key that has a default, that default is written
};

// The file's own text, comments included, with `comment` (lines without "#") and tables [[axis.NAME.effect]] after it;
// it reads back as a machine with these effects behind those of the file. Where the text cannot simply go on, because
// of assignments in `set` (as on the command line, ReadOptions), because the file writes its effects as a list in one
// line, or because an effect that an axis has only once is there already and so is replaced, the tree of the file is
// written anew, and its comments are lost. The figures that were expected of the machine without the effects,
// [[expected]], are left out. Throws MachineFileError when the result is no valid machine file, ValueError for effects
// with names, keys or values that `vocabulary` does not have. `file`: its path; `additions`: the effects of
// each axis.
std::string extended_machine(const std::filesystem::path& file, const Vocabulary& vocabulary,
                             const std::vector<std::string>& set, std::span<const AxisEffects> additions,
                             std::span<const std::string> comment);

// The same with values edited before: the tree of the file is written anew. `file`, `vocabulary`, `set`, `additions`,
// `comment` and errors: as above; `edits`: as of edited_machine.hpp.
std::string edited_machine(const std::filesystem::path& file, const Vocabulary& vocabulary,
                           const std::vector<std::string>& set, std::span<const MachineEdit> edits,
                           std::span<const AxisEffects> additions, std::span<const std::string> comment);

// One table [[axis.NAME.effect]] as text, its values in SI units. `force_motor`: the axis' motor is a force source,
// which some keys take in volts; `coordinate`: of the axis, whose units they have. Throws ValueError as above. `axis`:
// its name; `vocabulary` has the keys of `effect`.
std::string effect_table(const Vocabulary& vocabulary, const std::string& axis, const Effect& effect,
                         bool force_motor = false, const Coordinate& coordinate = {});

}  // namespace stiction::machine
