// Machine files read, described and extended with all that the simulation knows: the tables of its friction laws and
// effects. The functions are those of firmware/machine/file, which knows neither.
#pragma once

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/extended_machine.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/reference_page.hpp"

namespace stiction::sim {

// Every friction law and effect of the simulation.
const machine::Vocabulary& vocabulary();

// As in firmware/machine/file/machine_file.hpp: the machine of `file`, or of its `text`, with `options`. Throws
// machine::MachineFileError.
machine::Machine read_machine(const std::filesystem::path& file, const machine::ReadOptions& options = {});
machine::Machine parse_machine(const std::string& file, const std::string& text,
                               const machine::ReadOptions& options = {});

// As in firmware/machine/file/extended_machine.hpp: `effect` of `axis` as a table of the file, in units of a
// `force_motor` where it is one and of its `coordinate`; and `file` with the assignments `set`, the `additions` and
// lines of `comment`. They throw machine::ValueError and machine::MachineFileError.
std::string effect_table(const std::string& axis, const machine::Effect& effect, bool force_motor = false,
                         const machine::Coordinate& coordinate = {});
std::string extended_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                             std::span<const machine::AxisEffects> additions, std::span<const std::string> comment);

// See firmware/machine/file/description.hpp and reference_page.hpp.
const std::vector<machine::TableDescription>& machine_file_description();
std::string reference_page();

}  // namespace stiction::sim
