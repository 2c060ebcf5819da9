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

// See firmware/machine/file/machine_file.hpp.
machine::Machine read_machine(const std::filesystem::path& file, const machine::ReadOptions& options = {});
machine::Machine parse_machine(const std::string& file, const std::string& text,
                               const machine::ReadOptions& options = {});

// See firmware/machine/file/extended_machine.hpp.
std::string effect_table(const std::string& axis, const machine::Effect& effect, bool force_motor = false);
std::string extended_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                             std::span<const machine::AxisEffects> additions, std::span<const std::string> comment);

// See firmware/machine/file/description.hpp and reference_page.hpp.
const std::vector<machine::TableDescription>& machine_file_description();
std::string reference_page();

}  // namespace stiction::sim
