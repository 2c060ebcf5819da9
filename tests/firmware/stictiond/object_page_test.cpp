// The page of objects and the electronic data sheet (CiA 306) against the table and the server.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "firmware/stictiond/objects.hpp"
#include "tests/firmware/stictiond/served_objects.hpp"

namespace stiction::test {
namespace {

// One table: the page and the data sheet are printed from it.
std::string text_of(const std::string& file) {
  std::ifstream stream(std::string(STICTION_SOURCE_DIR) + "/" + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(ObjectPage, IsCurrent) {
  EXPECT_TRUE(text_of("docs/canopen_objects.md") == drive::object_page())
      << "docs/canopen_objects.md is a different one; print it with: stictiond --canopen-objects";
}

// Read as an INI file (CiA 306): every section and what it says of type and access against the server.
TEST_F(Objects, AreThoseOfTheDataSheet) {
  cycles(1);
  std::map<std::string, std::map<std::string, std::string>> sheet;
  std::istringstream lines(drive::eds_text());
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (line.front() == '[') {
      section = line.substr(1, line.size() - 2);
      EXPECT_FALSE(sheet.contains(section)) << section;
      sheet[section];
      continue;
    }
    const auto equals = line.find('=');
    ASSERT_NE(equals, std::string::npos) << line;
    sheet[section][line.substr(0, equals)] = line.substr(equals + 1);
  }
  for (const char* needed : {"FileInfo", "DeviceInfo", "MandatoryObjects", "OptionalObjects", "ManufacturerObjects"})
    EXPECT_TRUE(sheet.contains(needed)) << needed;
  std::set<std::string> listed;
  for (const char* list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"}) {
    const auto& rows = sheet[list];
    for (int i = 1; i <= std::stoi(rows.at("SupportedObjects")); ++i)
      listed.insert(rows.at(std::to_string(i)).substr(2));
  }
  EXPECT_EQ(sheet["MandatoryObjects"]["SupportedObjects"], "3") << "1000h, 1001h, 1018h";
  const std::map<std::string, std::size_t> bytes{{"0x0002", 1}, {"0x0003", 2}, {"0x0004", 4},
                                                 {"0x0005", 1}, {"0x0006", 2}, {"0x0007", 4}};
  int compared = 0;
  for (const auto& index : listed) {
    ASSERT_TRUE(sheet.contains(index)) << index;
    const auto number = static_cast<unsigned>(std::stoul(index, nullptr, 16));
    const bool record = sheet[index].contains("SubNumber");
    for (unsigned sub = 0; sub < (record ? std::stoul(sheet[index]["SubNumber"]) : 1); ++sub) {
      const auto& row = record ? sheet.at(index + fmt::format("sub{:X}", sub)) : sheet.at(index);
      const auto found = client.upload(number, sub);
      const auto* value = std::get_if<SdoClient::Bytes>(&found);
      if (value == nullptr) {
        EXPECT_EQ(std::get<std::uint32_t>(found), 0x08000024u) << index;
        continue;
      }
      if (const auto size = bytes.find(row.at("DataType")); size != bytes.end()) {
        EXPECT_EQ(value->size(), size->second) << index;
      }
      const bool writable = client.set(number, sub, 0, 4) != 0x06010002u;
      EXPECT_EQ(writable, row.at("AccessType") == "rw") << index;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 122 - 8) << "all but the empty history";
}

}  // namespace
}  // namespace stiction::test
