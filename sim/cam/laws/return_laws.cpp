// The rows of laws that rise and return, and of periodic ones.
#include "sim/cam/laws.hpp"
#include "sim/cam/laws/one_sided_polynomial.hpp"
#include "sim/cam/laws/rise_return_law.hpp"
#include "sim/cam/laws/scca.hpp"

namespace stiction::sim::cam {
namespace {

constexpr std::string_view dostrasil = "Dostrasil 2014, type 00100", without_dwell = "Dostrasil 2014, type 10101";

Law there_and_back_law(int number, std::string_view name, std::string_view english, std::string_view german,
                       std::string_view formula, Curve (*make)(const LawValues&)) {
  return {number, name,    english,   german, LawKind::rise_return, End::rest, End::rest, EndValues::own,
          {},     formula, dostrasil, make};
}

Law periodic_law(int number, std::string_view name, std::string_view english, std::string_view german,
                 std::string_view formula, Curve (*make)(const LawValues&),
                 std::vector<machine::ValueKey> parameters = {}) {
  return {number,
          name,
          english,
          german,
          LawKind::periodic,
          End::reversal,
          End::reversal,
          EndValues::own,
          std::move(parameters),
          formula,
          without_dwell,
          make};
}

}  // namespace

std::vector<Law> detail::return_laws() {
  return {
      there_and_back_law(70, "return_polynomial_3", "", "Hin-Rueck-Polynom 6. Grades", "64 x^3 (1-x)^3",
                         bump_polynomial<3>),
      there_and_back_law(71, "return_polynomial_4", "", "Hin-Rueck-Polynom 8. Grades", "256 x^4 (1-x)^4",
                         bump_polynomial<4>),
      there_and_back_law(72, "return_polynomial_2", "", "Hin-Rueck-Polynom 4. Grades", "16 x^2 (1-x)^2",
                         bump_polynomial<2>),
      there_and_back_law(73, "return_harmonic", "full harmonic", "Hin-Rueck-Sinuslinie", "(1 - cos 2 pi x) / 2",
                         full_harmonic),
      there_and_back_law(74, "return_sine_4", "sin^4", "Hin-Rueck-Sinus hoch 4", "sin^4 pi x", sine_fourth),
      there_and_back_law(75, "return_sine_3", "sin^3", "Hin-Rueck-Sinus hoch 3", "sin^3 pi x", sine_cube),
      there_and_back_law(76, "return_modified_sine", "", "Hin-Rueck modifizierte Sinuslinie",
                         "f(2x), f(2-2x) of modified_sine", there_and_back<modified_sine>),
      there_and_back_law(77, "return_double_harmonic", "", "Hin-Rueck-Doppelharmonische",
                         "f(2x), f(2-2x) of double_harmonic, which is sin^4 pi x", there_and_back<double_harmonic>),
      there_and_back_law(78, "return_eighth_power", "", "Hin-Rueck-Polynom aus 8. Grad",
                         "f(2x), f(2-2x) of eighth_power", there_and_back<eighth_power>),
      there_and_back_law(79, "return_harmonic_combination", "", "Hin-Rueck harmonische Kombination",
                         "f(2x), f(2-2x) of harmonic_combination", there_and_back<harmonic_combination>),
      periodic_law(80, "periodic_harmonic", "pure harmonic,eccentric", "reine Harmonische,Exzenter",
                   "(1 - cos 2 pi x) / 2", full_harmonic),
      periodic_law(81, "periodic_quartic", "", "periodisches Polynom 4. Grades",
                   "16 x^2 (1-x)^2; y''' jumps at the seam", bump_polynomial<2>),
      periodic_law(82, "periodic_two_harmonics", "", "periodische Zwei-Harmonische",
                   "(1 - cos a)/2 + e sin a (1 - cos a), a = 2 pi x, over its peak", two_harmonic_return,
                   {law_parameter("e", {-0.5, 0.5}, 0.1, "share of the second harmonic")}),
  };
}

}  // namespace stiction::sim::cam
