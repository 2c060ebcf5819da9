// STEP files after AP214 (ISO 10303-214), written and read back.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

namespace stiction::host::solid {

// Writes `shape` as the product `name` into `file`, in mm; the sentences of `head` and the CRC-32 of all other lines
// become the file's description. Throws std::runtime_error where that fails.
void write_step(const TopoDS_Shape& shape, const std::string& name, const std::vector<std::string>& head,
                const std::string& file);

// The shapes of `file`. Throws std::runtime_error where it is no STEP file.
TopoDS_Shape read_step(const std::string& file);

}  // namespace stiction::host::solid
