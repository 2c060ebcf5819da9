#include "host/solid/step_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <APIHeaderSection_MakeHeader.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_HArray1OfHAsciiString.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <TCollection_HAsciiString.hxx>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace stiction::host::solid {
namespace {

// In place of the checksum until it is known.
constexpr std::string_view mark = "########";

opencascade::handle<TCollection_HAsciiString> words(const std::string& text) {
  return new TCollection_HAsciiString(text.c_str());
}

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The line with the mark gets the CRC-32 (of zlib) of all lines but itself, as in the other files for the shop.
void add_checksum(const std::string& file) {
  std::string text = content(file), others;
  const auto at = text.find(mark);
  if (at == std::string::npos)
    throw std::runtime_error(file + ": found no place for the checksum; expected a description");
  const auto begin = text.rfind('\n', at) + 1, end = text.find('\n', at) + 1;
  others = text.substr(0, begin) + text.substr(end);
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(others.data()), static_cast<uInt>(others.size()));
  text.replace(at, mark.size(), fmt::format("{:08x}", sum));
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace

void write_step(const TopoDS_Shape& shape, const std::string& name, const std::vector<std::string>& head,
                const std::string& file) {
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetCVal("write.step.product.name", name.c_str());
  STEPControl_Writer writer;
  if (writer.Transfer(shape, STEPControl_ManifoldSolidBrep) != IFSelect_RetDone)
    throw std::runtime_error(file + ": found a shape that cannot be written; expected a solid");
  APIHeaderSection_MakeHeader header(writer.Model());
  opencascade::handle<Interface_HArray1OfHAsciiString> lines =
      new Interface_HArray1OfHAsciiString(1, static_cast<int>(head.size()) + 1);
  for (std::size_t k = 0; k < head.size(); ++k) lines->SetValue(static_cast<int>(k) + 1, words(head[k]));
  lines->SetValue(lines->Upper(), words(fmt::format("CRC-32 of the other lines: {}", mark)));
  header.SetDescription(lines);
  header.SetName(words(name));
  header.SetOriginatingSystem(words("stiction-solids"));
  if (writer.Write(file.c_str()) != IFSelect_RetDone)
    throw std::runtime_error(file + ": found no way to write it; expected a folder that can be written to");
  add_checksum(file);
}

TopoDS_Shape read_step(const std::string& file) {
  STEPControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone)
    throw std::runtime_error(file + ": found no STEP file; expected one");
  reader.TransferRoots();
  return reader.OneShape();
}

}  // namespace stiction::host::solid
