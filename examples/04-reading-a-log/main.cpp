// Reading a log without a library: a CSV of your drive, of example 01, or of a one-axis machine from
// `stiction simulate EXPERIMENT --log FILE` (format: docs/formats.md), and what it says about the machine. Fits
//   force constant * i = mass * a + coulomb * sign(v) + viscous * v + constant
// by least squares and prints the four. usage: reading_a_log LOG FORCE_CONSTANT(N/A)
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

// Leading "# key: value" lines, a header "x[m]", a row a sample; point as decimal mark.
struct Log {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  explicit Log(const char* path) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream cells(line);
      std::string cell;
      std::vector<double> row;
      const bool header = columns.empty();
      while (std::getline(cells, cell, ','))
        if (header)
          columns.push_back(cell);
        else
          row.push_back(std::strtod(cell.c_str(), nullptr));
      if (!header && row.size() == columns.size()) rows.push_back(row);
    }
  }
  // Of "x[m]" or "X.x[m]"; a log in other units names them.
  std::size_t column(const std::string& name) const {
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (columns[k] == name || (columns[k].size() > 2 && columns[k].substr(2) == name)) return k;
    std::fprintf(stderr, "found no column %s; expected t[s], v_set[m/s], a_set[m/s^2], x[m], i[A]\n", name.c_str());
    std::exit(1);
  }
};

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: reading_a_log LOG FORCE_CONSTANT(N/A)\n"), 2;
  const Log log(argv[1]);
  const double constant = std::strtod(argv[2], nullptr);
  const std::size_t v = log.column("v_set[m/s]"), a = log.column("a_set[m/s^2]"), i = log.column("i[A]");
  // Normal equations of the four unknowns, with the force in the last column.
  std::array<std::array<double, 5>, 4> m{};
  for (const auto& row : log.rows) {
    if (std::abs(row[v]) < 0.01) continue;  // near a reversal friction is not Coulomb's
    const std::array<double, 5> terms{row[a], row[v] > 0.0 ? 1.0 : -1.0, row[v], 1.0, constant * row[i]};
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 5; ++k) m[j][k] += terms[j] * terms[k];
  }
  for (std::size_t j = 0; j < 4; ++j)  // Gauss and Jordan; the matrix is positive definite
    for (std::size_t other = 0; other < 4; ++other) {
      const double share = m[other][j] / m[j][j];
      for (std::size_t k = 0; other != j && k < 5; ++k) m[other][k] -= share * m[j][k];
    }
  const char* const names[] = {"mass: %.2f kg\n", "coulomb: %.2f N\n", "viscous: %.1f N s/m\n", "constant: %.2f N\n"};
  std::printf("%zu samples of %s\n", log.rows.size(), argv[1]);
  for (std::size_t j = 0; j < 4; ++j) std::printf(names[j], m[j][4] / m[j][j]);
}
