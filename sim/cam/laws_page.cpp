#include "sim/cam/laws_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/laws.hpp"

namespace stiction::sim::cam {
namespace {

// Of the picture: columns of cells, their size in px, and the room for a curve in them.
constexpr int columns = 6, cell_width = 200, cell_height = 130, room_width = 170, room_height = 84;
constexpr int drawn_points = 96;

// The two laws with free coefficients are shown by an example.
LawValues shown_values(const Law& law) {
  LawValues values = default_values(law);
  if (law.name == "polynomial") values["coefficients"] = {0.0, 0.0, 10.0, -15.0, 6.0};
  if (law.name == "power_polynomial") values["powers"] = {3.0, 5.0, 7.0};
  return values;
}

std::string names_text(std::string_view names) {
  std::string text(names);
  for (std::size_t at = 0; (at = text.find(',', at)) != std::string::npos; at += 2) text.replace(at, 1, ", ");
  return text;
}

std::string parameters_text(const Law& law) {
  if (law.ends == EndValues::slopes) {
    const auto c = *law.parameters[law.parameters.size() - 4].fallback;
    const auto lambda = *law.parameters[law.parameters.size() - 3].fallback;
    std::string text = "modifications";
    if (c != 1.0) text += fmt::format(", c = {:.4g}", c);
    if (lambda != 0.5) text += fmt::format(", lambda = {:.4g}", lambda);
    for (std::size_t k = 0; k + 4 < law.parameters.size(); ++k)
      text += fmt::format(", {} = {:.4g}", law.parameters[k].key, *law.parameters[k].fallback);
    return text;
  }
  std::string text;
  for (const auto& parameter : law.parameters)
    text += (text.empty() ? "" : ", ") + std::string(parameter.key) +
            (parameter.fallback ? fmt::format(" = {:.4g}", *parameter.fallback) : "");
  return text.empty() ? "–" : text;
}

// "|" would end a cell.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string row_of(const Law& law) {
  const auto values = shown_values(law);
  const auto curve = unit_curve(law, values);
  const auto c = characteristics(law, values, curve);
  auto names = names_text(law.german);
  if (!law.english.empty()) names += "; " + names_text(law.english);
  return fmt::format("| {} | `{}` | {} | {} | {} | `{}` | {:.4g} | {:.4g} / {:.4g} | {:.4g} | {:.4g} | {} |\n",
                     law.number, law.name, names, task_of(law), parameters_text(law), cell(law.formula), c.speed,
                     c.acceleration, c.deceleration, c.jerk, c.torque, c.jerks_without_bound() ? "J" : "");
}

std::string path_of(const Curve& curve, int order) {
  const auto range = extremes(curve, order);
  const double low = std::min(range.lowest.value, 0.0), high = std::max(range.highest.value, 0.0);
  const double size = high - low > 0.0 ? high - low : 1.0;
  std::string path;
  for (const Piece& piece : curve.pieces()) {
    const int count = std::max(2, static_cast<int>(drawn_points * piece.length()));
    for (int k = 0; k <= count; ++k) {
      const double x = k == count ? piece.end : piece.begin + piece.length() * k / count;
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x * room_width,
                          room_height * (1.0 - (piece.derivative(x, order) - low) / size));
    }
  }
  return path;
}

}  // namespace

std::string laws_markdown() {
  std::string text =
      "| | law | names | task | parameters | formula | Cv | Ca | Cj | C_M | |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Law& law : laws()) text += row_of(law);
  return text;
}

std::string laws_svg() {
  const auto count = static_cast<int>(laws().size());
  const int rows = (count + columns - 1) / columns;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"10\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      columns * cell_width, rows * cell_height + 20);
  constexpr std::array<std::string_view, 3> colours{"#222222", "#2a6fbb", "#c0392b"};
  constexpr std::array<std::string_view, 3> names{"y", "y'", "y''"};
  for (std::size_t order = 0; order < 3; ++order)
    text +=
        fmt::format("<text x=\"{}\" y=\"14\" fill=\"{}\">{}</text>\n", 10 + 30 * order, colours[order], names[order]);
  for (int k = 0; k < count; ++k) {
    const Law& law = laws()[static_cast<std::size_t>(k)];
    const auto curve = unit_curve(law, shown_values(law));
    text +=
        fmt::format("<g transform=\"translate({} {})\"><text y=\"10\">{} {}</text><g transform=\"translate(0 20)\">\n",
                    10 + k % columns * cell_width, 20 + k / columns * cell_height, law.number, law.name);
    for (int order = 2; order >= 0; --order)
      text += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\"/>\n", path_of(curve, order),
                          colours[static_cast<std::size_t>(order)]);
    text += "</g></g>\n";
  }
  return text + "</svg>\n";
}

}  // namespace stiction::sim::cam
