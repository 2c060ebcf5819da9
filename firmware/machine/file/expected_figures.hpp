// Rows [[expected]] of a machine file: reads and checks them, and finds those that are for the machine as it runs.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/file/document.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// Throws MachineFileError for an unknown key or name, a value without a proper unit, a row that is there twice.
// `document`: of the file; `machine`: read from it. `models`: the friction models that there are. The overrides of
// `when` are looked at by mark_in_force().
std::vector<ExpectedFigure> read_expected_figures(const Document& document, const Machine& machine,
                                                  std::span<const std::string_view> models);

// Sets ExpectedFigure::in_force of the `rows`. `file`: as it is without overrides. `running`: the machine that runs.
// `with`: makes the document of the file with the overrides of an experiment and KEY=VALUE, and reads its machine,
// which checks them; throws MachineFileError. A row whose overrides the file does not take is a MachineFileError at the
// row.
using DocumentWith = std::function<Document(const std::string& experiment, std::span<const std::string> set)>;
void mark_in_force(std::vector<ExpectedFigure>& rows, const Document& file, const Document& running,
                   const std::string& experiment, const DocumentWith& with);

}  // namespace stiction::machine
