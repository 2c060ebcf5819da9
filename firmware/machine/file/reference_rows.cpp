#include "firmware/machine/file/reference_rows.hpp"

#include <fmt/format.h>

#include <string>
#include <type_traits>

#include "firmware/machine/file/name_check.hpp"
#include "firmware/machine/file/table_reader.hpp"

namespace stiction::machine {
namespace {

class ReferenceReader {
 public:
  ReferenceReader(const Document& document, const std::vector<std::string_view>& models, const Machine& machine)
      : document_(document), models_(models) {
    for (const AxisModel& axis : machine.axes) axes_.push_back(axis.name);
  }

  template <class Row>
  void read_rows(const toml::node& node, const std::string& path, std::vector<Row>& rows) const {
    if (!node.is_array()) document_.fail(node.source(), path, describe_node(node), fmt::format("rows [[{}]]", path));
    for (const toml::node& row : *node.as_array()) {
      const std::string row_path = fmt::format("{}[{}]", path, rows.size());
      rows.emplace_back();
      document_.attempt([&] { rows.back() = read_row<Row>(row, row_path); });
    }
  }

 private:
  template <class Row>
  Row read_row(const toml::node& node, const std::string& path) const {
    const TableReader reader(document_, false);
    const toml::table& table = reader.as_table(node, path, Table<Row>::text);
    const std::size_t errors = document_.errors();
    Row row = reader.read<Row>(table, path);
    if (document_.errors() > errors) return row;
    check_name(document_, table, path, "axis", row.axis, axes_, "an axis of this machine");
    if constexpr (std::is_same_v<Row, CircleReference>) check_source(table, path, row);
    return row;
  }

  // A measured row stands for the machine, a published simulation for one friction model.
  void check_source(const toml::table& table, const std::string& path, const CircleReference& row) const {
    const toml::node* friction = table.get("friction");
    const std::string key = join_key(path, "friction");
    if (row.measured && friction != nullptr)
      document_.fail(friction->source(), key, describe_node(*friction), "none with source \"measured\"");
    if (row.measured) return;
    if (friction == nullptr)
      document_.fail(table.source(), key, "no such key",
                     fmt::format("the friction model of the published simulation: {}", quoted_list(models_)));
    check_name(document_, table, path, "friction", *row.friction, models_, "a friction model");
  }

  const Document& document_;
  const std::vector<std::string_view>& models_;
  std::vector<std::string_view> axes_;
};

}  // namespace

void read_references(const Document& document, const std::vector<std::string_view>& models, Machine& machine) {
  const toml::node* references = document.root().get("reference");
  if (references == nullptr) return;
  const ReferenceReader reader(document, models, machine);
  for (auto&& [kind, node] :
       TableReader(document, false).as_table(*references, "reference", "published or measured rows")) {
    const std::string path = join_key("reference", kind.str());
    if (kind.str() == "circle")
      reader.read_rows(node, path, machine.circle_references);
    else if (kind.str() == "steady_friction")
      reader.read_rows(node, path, machine.steady_friction_references);
    else if (kind.str() == "presliding")
      reader.read_rows(node, path, machine.presliding_references);
    else
      document.attempt([&, &name = kind] {
        document.fail_unknown(name.source(), path, {"circle", "steady_friction", "presliding"});
      });
  }
}

}  // namespace stiction::machine
