// The rows of laws for tasks other than rest to rest.
#include "sim/cam/hermite.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/laws/hermite_law.hpp"
#include "sim/cam/laws/one_sided_polynomial.hpp"
#include "sim/cam/laws/one_sided_sine.hpp"
#include "sim/cam/laws/smooth_polynomial.hpp"

namespace stiction::sim::cam {
namespace {

constexpr std::string_view vdi_2143 = "VDI 2143, part 1", this_project = "this project", rothbart = "Rothbart 1956",
                           eighth = "recalled; boundary conditions checked";

Law one_sided(int number, std::string_view name, std::string_view english, std::string_view german, const char* task,
              std::string_view formula, std::string_view source, Curve (*make)(const LawValues&)) {
  return {number,         name, english, german, LawKind::rise, static_cast<End>(task[0]), static_cast<End>(task[2]),
          EndValues::own, {},   formula, source, make};
}

std::vector<Law> fixed_laws() {
  return {
      one_sided(31, "eighth_power", "8th power,eighth power polynomial", "Polynom 8. Grades", "R-U",
                "6.09755x^3 - 20.7804x^5 + 26.73155x^6 - 13.60965x^7 + 2.56095x^8", eighth, eighth_power),
      one_sided(32, "double_harmonic", "double harmonic", "Doppelharmonische", "R-U",
                "((1 - cos pi x) - (1 - cos 2 pi x)/4) / 2", rothbart, double_harmonic),
      one_sided(33, "double_harmonic_mirrored", "", "gespiegelte Doppelharmonische", "U-R",
                "1 - f(1-x) of double_harmonic", rothbart, mirror<double_harmonic>),
      one_sided(34, "quartic_rest_reversal", "", "Polynom 4. Grades Rast-Umkehr", "R-U", "4x^3 - 3x^4", vdi_2143,
                quartic_rest_reversal),
      one_sided(35, "quintic_rest_reversal", "", "Polynom 5. Grades Rast-Umkehr", "R-U", "5x^4 - 4x^5", vdi_2143,
                quintic_rest_reversal),
      one_sided(36, "quartic_reversals", "", "Polynom 4. Grades Umkehr-Umkehr", "U-U", "2x^2 - x^4", vdi_2143,
                quartic_reversals),
      one_sided(37, "quartic_reversal_rest", "", "Polynom 4. Grades Umkehr-Rast", "U-R",
                "1 - f(1-x) of quartic_rest_reversal", vdi_2143, mirror<quartic_rest_reversal>),
      one_sided(38, "harmonic_combination", "", "harmonische Kombination", "R-U",
                "y'' half a sine to 0.4, then a quarter of a sine that brakes", vdi_2143, harmonic_combination),
      one_sided(39, "harmonic_combination_mirrored", "", "gespiegelte harmonische Kombination", "U-R",
                "1 - f(1-x) of harmonic_combination", vdi_2143, mirror<harmonic_combination>),
      one_sided(40, "half_cycloid_rest_speed", "half cycloid", "halbe geneigte Sinuslinie Rast-Geschwindigkeit", "R-G",
                "x - sin(pi x) / pi", vdi_2143, half_cycloid),
      one_sided(41, "half_cycloid_speed_rest", "", "halbe geneigte Sinuslinie Geschwindigkeit-Rast", "G-R",
                "x + sin(pi x) / pi", vdi_2143, mirror<half_cycloid>),
      one_sided(42, "half_harmonic_reversal_speed", "half harmonic", "halbe Sinuslinie Umkehr-Geschwindigkeit", "U-G",
                "1 - cos(pi x / 2)", vdi_2143, half_harmonic),
      one_sided(43, "half_harmonic_speed_reversal", "", "halbe Sinuslinie Geschwindigkeit-Umkehr", "G-U",
                "sin(pi x / 2)", vdi_2143, mirror<half_harmonic>),
      one_sided(44, "half_parabola_rest_speed", "half parabola", "halbe Parabel Rast-Geschwindigkeit", "R-G", "x^2",
                vdi_2143, half_parabola),
      one_sided(45, "half_parabola_speed_rest", "", "halbe Parabel Geschwindigkeit-Rast", "G-R", "2x - x^2", vdi_2143,
                mirror<half_parabola>),
      one_sided(46, "quartic_rest_speed", "half 3-4-5", "Polynom 4. Grades Rast-Geschwindigkeit", "R-G", "2x^3 - x^4",
                vdi_2143, quartic_rest_speed),
      one_sided(47, "quartic_speed_rest", "", "Polynom 4. Grades Geschwindigkeit-Rast", "G-R",
                "1 - f(1-x) of quartic_rest_speed", vdi_2143, mirror<quartic_rest_speed>),
  };
}

machine::ValueKey boundary(std::string_view key, double fallback, std::string_view text) {
  return law_parameter(key, law_range(), fallback, text);
}

// What the task leaves free at its ends, of the unit law.
std::vector<machine::ValueKey> free_values(End start, End end) {
  const auto moves = [](End e) { return e == End::constant_speed || e == End::motion; };
  const auto bends = [](End e) { return e == End::reversal || e == End::motion; };
  std::vector<machine::ValueKey> keys;
  if (moves(start)) keys.push_back(boundary("start_slope", 1.0, "speed at the start"));
  if (bends(start)) keys.push_back(boundary("start_acceleration", 4.0, "acceleration at the start"));
  if (moves(end)) keys.push_back(boundary("end_slope", 1.0, "speed at the end"));
  if (bends(end)) keys.push_back(boundary("end_acceleration", -4.0, "acceleration at the end"));
  return keys;
}

struct HermiteName {
  const char* task;
  std::string_view name;
  std::string_view german;
};

// In the order of Lenze's list of the tasks, without R-R, which is 3-4-5.
constexpr HermiteName hermite_names[] = {
    {"R-G", "hermite_rest_speed", "Polynom 5. Grades Rast-Geschwindigkeit"},
    {"R-U", "hermite_rest_reversal", "Polynom 5. Grades Rast-Umkehr (Randwerte)"},
    {"R-B", "hermite_rest_motion", "Polynom 5. Grades Rast-Bewegung"},
    {"G-R", "hermite_speed_rest", "Polynom 5. Grades Geschwindigkeit-Rast"},
    {"G-G", "hermite_speed_speed", "Polynom 5. Grades Geschwindigkeit-Geschwindigkeit"},
    {"G-U", "hermite_speed_reversal", "Polynom 5. Grades Geschwindigkeit-Umkehr"},
    {"G-B", "hermite_speed_motion", "Polynom 5. Grades Geschwindigkeit-Bewegung"},
    {"U-R", "hermite_reversal_rest", "Polynom 5. Grades Umkehr-Rast"},
    {"U-G", "hermite_reversal_speed", "Polynom 5. Grades Umkehr-Geschwindigkeit"},
    {"U-U", "hermite_reversal_reversal", "Polynom 5. Grades Umkehr-Umkehr"},
    {"U-B", "hermite_reversal_motion", "Polynom 5. Grades Umkehr-Bewegung"},
    {"B-R", "hermite_motion_rest", "Polynom 5. Grades Bewegung-Rast"},
    {"B-G", "hermite_motion_speed", "Polynom 5. Grades Bewegung-Geschwindigkeit"},
    {"B-U", "hermite_motion_reversal", "Polynom 5. Grades Bewegung-Umkehr"},
    {"B-B", "hermite", "Polynom 5. Grades Bewegung-Bewegung"},
};

std::vector<Law> hermite_laws() {
  std::vector<Law> all;
  int number = 48;
  for (const auto& [task, name, german] : hermite_names) {
    const auto start = static_cast<End>(task[0]), end = static_cast<End>(task[2]);
    all.push_back({number++, name, "", german, LawKind::rise, start, end, EndValues::second, free_values(start, end),
                   "polynomial of 5th degree through y, y', y'' at both ends", vdi_2143, hermite_law<quintic>});
  }
  auto keys = free_values(End::motion, End::motion);
  keys.push_back(boundary("start_jerk", 0.0, "jerk at the start"));
  keys.push_back(boundary("end_jerk", 0.0, "jerk at the end"));
  all.push_back({63, "hermite_septic", "", "Polynom 7. Grades Bewegung-Bewegung", LawKind::rise, End::motion,
                 End::motion, EndValues::third, std::move(keys),
                 "polynomial of 7th degree through y, y', y'', y''' at both ends", this_project, hermite_law<septic>});
  return all;
}

}  // namespace

std::vector<Law> detail::one_sided_laws() {
  std::vector<Law> all = fixed_laws();
  const auto more = hermite_laws();
  all.insert(all.end(), more.begin(), more.end());
  all.push_back({68, "polynomial_3_4_5_slopes", "", "Polynom 5. Grades mit Randsteigungen", LawKind::rise,
                 End::constant_speed, End::constant_speed, EndValues::slopes, modifications(0.7, 0.4, 0.2, 0.5),
                 "3-4-5 with c = 0.7, lambda = 0.4, slopes 0.2 and 0.5", vdi_2143, smooth_polynomial<3>});
  return all;
}

}  // namespace stiction::sim::cam
