// The rows of laws from rest to rest.
#include "sim/cam/laws.hpp"
#include "sim/cam/laws/acceleration_trapezoid.hpp"
#include "sim/cam/laws/exponential_law.hpp"
#include "sim/cam/laws/free_polynomial.hpp"
#include "sim/cam/laws/harmonic_series.hpp"
#include "sim/cam/laws/one_sided_polynomial.hpp"
#include "sim/cam/laws/scca.hpp"
#include "sim/cam/laws/smooth_polynomial.hpp"

namespace stiction::sim::cam {
namespace {

constexpr std::string_view vdi = "VDI 2143, part 1", norton = "Norton, Cam Design and Manufacturing Handbook",
                           own = "this project", recalled = "recalled; boundary conditions checked";

// A law from rest to rest that takes the modifications.
Law rest_law(int number, std::string_view name, std::string_view english, std::string_view german,
             std::string_view formula, std::string_view source, Curve (*make)(const LawValues&),
             std::vector<machine::ValueKey> parameters = detail::modifications()) {
  return {
      number,  name,   english, german, LawKind::rise, End::rest, End::rest, EndValues::slopes, std::move(parameters),
      formula, source, make};
}

// With one parameter before those of the modifications.
std::vector<machine::ValueKey> with_parameter(std::vector<machine::ValueKey> first) {
  const auto rest = detail::modifications();
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

std::vector<machine::ValueKey> with_ramp(double ramp) {
  return with_parameter({law_parameter("ramp", {0.001, 0.249}, ramp, "length of one ramp, of the interval")});
}

std::vector<machine::ValueKey> with_k(double k) {
  return with_parameter({law_parameter("k", {0.25, 20.0}, k, "exponent: larger is slower at the ends")});
}

std::vector<Law> basic_laws() {
  using detail::modifications;
  return {
      {1,
       "linear",
       "straight line,constant velocity",
       "Gerade,lineare Bewegung",
       LawKind::rise,
       End::constant_speed,
       End::constant_speed,
       EndValues::own,
       {},
       "x",
       vdi,
       linear},
      rest_law(2, "parabola", "constant acceleration,parabolic", "quadratische Parabel", "2x^2 to 1/2, symmetric", vdi,
               parabola),
      rest_law(3, "cubic", "2-3 polynomial", "kubische Parabel,Polynom 3. Grades", "3x^2 - 2x^3", vdi,
               smooth_polynomial<2>),
      rest_law(4, "triangular_acceleration", "triangle", "Beschleunigungsdreieck",
               "y'' from 0 to 8 at 1/4 and back to 0 at 1/2, in lines; symmetric", vdi, triangular_acceleration),
      rest_law(5, "simple_sine", "harmonic,simple harmonic", "einfache Sinuslinie", "(1 - cos pi x) / 2", vdi,
               simple_sine),
      rest_law(6, "sloping_sine", "cycloidal,cycloid,Bestehorn", "geneigte Sinuslinie,Bestehorn-Sinuslinie,Sinoide",
               "x - sin(2 pi x) / 2 pi", vdi, sloping_sine),
      rest_law(7, "modified_trapezoid", "modified trapezoidal", "modifiziertes Beschleunigungstrapez",
               "SCCA with b, c, d = 1/4, 1/2, 1/4", vdi, modified_trapezoid),
      rest_law(8, "modified_sine", "modified sinusoidal", "modifizierte Sinuslinie", "SCCA with b, c, d = 1/4, 0, 3/4",
               vdi, modified_sine),
      rest_law(9, "scca", "sine constant cosine acceleration", "Sinus-Konstant-Kosinus-Beschleunigung",
               "y'' a quarter of a sine over b/2, constant over c/2, a quarter of a cosine over d/2; symmetric", norton,
               scca,
               with_parameter({law_parameter("sine", {0.0, 0.999}, 0.25, "share b of the sine"),
                               law_parameter("constant", {0.0, 0.999}, 0.25, "share c of the constant part")})),
      rest_law(10, "trapezoid_8", "trapezoidal acceleration", "Beschleunigungstrapez", "y'' with linear ramps of 1/8",
               norton, ramp_trapezoid, with_ramp(1.0 / 8.0)),
      rest_law(11, "trapezoid_6", "", "Beschleunigungstrapez 1/6", "y'' with linear ramps of 1/6", norton,
               ramp_trapezoid, with_ramp(1.0 / 6.0)),
      rest_law(12, "sine_squared_trapezoid", "", "Sinusquadrat-Beschleunigungstrapez", "y'' with sin^2 ramps of 1/8",
               own, sine_squared_trapezoid, with_ramp(1.0 / 8.0)),
  };
}

std::vector<Law> laws_with_a_line() {
  using detail::modifications;
  return {
      rest_law(13, "modified_sine_line_5", "", "modifizierte Sinuslinie mit Gerade 1/5",
               "modified sine with c = 4/5: a line of 1/5", vdi, modified_sine, modifications(0.8)),
      rest_law(14, "sine_line_5", "", "Sinus-Gerade-Kombination 1/5", "sloping sine with c = 4/5", vdi, sloping_sine,
               modifications(0.8)),
      rest_law(15, "modified_trapezoid_line_5", "", "modifiziertes Beschleunigungstrapez mit Gerade 1/5",
               "modified trapezoid with c = 4/5", vdi, modified_trapezoid, modifications(0.8)),
      rest_law(16, "modified_sine_line_3", "MSC 33", "modifizierte Sinuslinie mit Gerade 1/3",
               "modified sine with c = 2/3: a line of 1/3", vdi, modified_sine, modifications(2.0 / 3.0)),
      rest_law(17, "sine_line_3", "", "Sinus-Gerade-Kombination 1/3", "sloping sine with c = 2/3", vdi, sloping_sine,
               modifications(2.0 / 3.0)),
      rest_law(18, "modified_trapezoid_line_3", "", "modifiziertes Beschleunigungstrapez mit Gerade 1/3",
               "modified trapezoid with c = 2/3", vdi, modified_trapezoid, modifications(2.0 / 3.0)),
      rest_law(19, "modified_sine_line_2", "MSC 50", "modifizierte Sinuslinie mit Gerade 1/2",
               "modified sine with c = 1/2: a line of 1/2", vdi, modified_sine, modifications(0.5)),
      rest_law(20, "sine_line_2", "", "Sinus-Gerade-Kombination 1/2", "sloping sine with c = 1/2", vdi, sloping_sine,
               modifications(0.5)),
      rest_law(21, "modified_trapezoid_line_2", "", "modifiziertes Beschleunigungstrapez mit Gerade 1/2",
               "modified trapezoid with c = 1/2", vdi, modified_trapezoid, modifications(0.5)),
      rest_law(64, "modified_sine_asymmetric", "", "asymmetrische modifizierte Sinuslinie",
               "modified sine with lambda = 2/5", vdi, modified_sine, modifications(1.0, 0.4)),
      rest_law(65, "sloping_sine_asymmetric", "", "asymmetrische geneigte Sinuslinie", "sloping sine with lambda = 2/5",
               vdi, sloping_sine, modifications(1.0, 0.4)),
      rest_law(66, "polynomial_3_4_5_asymmetric", "", "asymmetrisches Polynom 5. Grades", "3-4-5 with lambda = 2/5",
               vdi, smooth_polynomial<3>, modifications(1.0, 0.4)),
      rest_law(67, "polynomial_3_4_5_line", "", "Polynom 5. Grades mit Gerade", "3-4-5 with c = 3/5", vdi,
               smooth_polynomial<3>, modifications(0.6)),
  };
}

std::vector<Law> polynomials_and_series() {
  return {
      rest_law(22, "polynomial_3_4_5", "3-4-5,3-4-5 polynomial", "Polynom 5. Grades", "10x^3 - 15x^4 + 6x^5", vdi,
               smooth_polynomial<3>),
      rest_law(23, "polynomial_4_5_6_7", "4-5-6-7,4-5-6-7 polynomial", "Polynom 7. Grades",
               "35x^4 - 84x^5 + 70x^6 - 20x^7", norton, smooth_polynomial<4>),
      rest_law(24, "polynomial_5_9", "5-6-7-8-9", "Polynom 9. Grades", "powers 5 to 9, four derivatives 0 at the ends",
               own, smooth_polynomial<5>),
      rest_law(25, "polynomial_6_11", "", "Polynom 11. Grades", "powers 6 to 11, five derivatives 0 at the ends", own,
               smooth_polynomial<6>),
      rest_law(26, "polynomial_7_13", "", "Polynom 13. Grades", "powers 7 to 13, six derivatives 0 at the ends", own,
               smooth_polynomial<7>),
      rest_law(27, "gutman", "Gutman 1-3", "Gutman 1-3 Bewegung", "x - (15/32 pi) sin 2 pi x - (1/96 pi) sin 6 pi x",
               recalled, gutman),
      rest_law(28, "freudenstein_1_3", "", "Freudenstein 1-3 Bewegung",
               "x - (1/2 pi)(27/28 sin 2 pi x + 1/84 sin 6 pi x)", recalled, freudenstein_3),
      rest_law(29, "freudenstein_1_3_5", "", "Freudenstein 1-3-5 Bewegung",
               "x - (1/2 pi)(1125/1192)(sin 2 pi x + 1/54 sin 6 pi x + 1/1250 sin 10 pi x)", recalled, freudenstein_5),
      rest_law(30, "two_harmonics", "", "Zwei-Harmonische", "x - (1/2 pi)(4/3 sin 2 pi x - 1/6 sin 4 pi x)", own,
               two_harmonics),
      {69,
       "polynomial_asymmetric_6",
       "",
       "asymmetrisches Polynom 6. Grades",
       LawKind::rise,
       End::rest,
       End::rest,
       EndValues::own,
       {},
       "3-4-5 plus 6.4 x^3 (1-x)^3",
       own,
       asymmetric_sixth},
      rest_law(83, "exponential_1", "exponential", "Exponentialgesetz", "y' ~ exp(-k / (4x(1-x))), k = 1", own,
               exponential_law, with_k(1.0)),
      rest_law(84, "exponential_2", "", "Exponentialgesetz k=2", "y' ~ exp(-k / (4x(1-x))), k = 2", own,
               exponential_law, with_k(2.0)),
  };
}

// A list of numbers, which has no default.
machine::ValueKey number_list(std::string_view key, machine::Range range, std::string_view text) {
  return {key, "1", "", range, true, false, {}, text, "", false};
}

std::vector<Law> free_laws() {
  return {
      {85,
       "polynomial",
       "free polynomial",
       "freies Polynom",
       LawKind::rise,
       End::motion,
       End::motion,
       EndValues::own,
       {number_list("coefficients", law_range(), "of x, x^2, ...; their sum is 1")},
       "sum of c_n x^n",
       vdi,
       free_polynomial},
      {86,
       "power_polynomial",
       "polydyne",
       "Potenzpolynom",
       LawKind::rise,
       End::motion,
       End::motion,
       EndValues::own,
       {number_list("powers", {1.0, 24.0}, "rising whole numbers, such as 3, 4, 5")},
       "sum of C_i x^p_i, C_i = product of p_j / (p_j - p_i)",
       "Stoddart 1953",
       power_polynomial},
  };
}

}  // namespace

std::vector<Law> detail::rest_laws() {
  std::vector<Law> all = basic_laws();
  for (const auto& part : {laws_with_a_line(), polynomials_and_series(), free_laws()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace stiction::sim::cam
