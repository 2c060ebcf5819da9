// What an experiment other than the circle leaves behind: figures with what the source says of them, and charts.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace stiction::sim {

// What a source says a figure must be.
struct Expectation {
  double value = 0.0;      // in the figure's unit
  double tolerance = 0.0;  // in the figure's unit
  std::string source;      // document and place
};

struct Figure {
  std::string name;  // "peak_deviation_lugre"; a machine file calls it "peak_deviation"
  std::string unit;  // as it is shown, "um"; empty for a plain number
  std::string text;  // what it is, for readers
  double value = 0.0;
  std::optional<Expectation> expected;
  std::string friction{};  // the model that its name contains; empty: none
  std::string axis{};      // the axis that it is of; empty: of the machine

  // Empty where nothing is expected.
  std::optional<bool> holds() const {
    if (!expected) return std::nullopt;
    return std::abs(value - expected->value) <= expected->tolerance;
  }
};

// What a series shows of two simulations and a machine, wherever it is drawn: its colour.
enum class SeriesRole {
  other,     // the colour of its friction model, or the next free one
  measured,  // on the machine
  before,    // simulated, before the machine file was extended
  after,     // and extended
};

// The figure of a run with one friction model, whose name its own contains.
inline Figure of_model(Figure figure, const std::string& friction) {
  figure.friction = friction;
  return figure;
}

struct Series {
  std::string name;
  std::vector<double> x, y;
  bool points = false;  // markers instead of a line: measured or published values
  bool bars = false;    // bars from zero instead of a line: one value a count
  SeriesRole role = SeriesRole::other;
  std::string friction{};  // the name of the friction model that it shows; empty: of none
};

// A vertical distance at one abscissa, such as a margin.
struct Distance {
  double x, from, to;
  std::string label;
};

// How much of the page a chart takes. Charts over time are wide and low of themselves.
struct Shape {
  enum class Height { usual, low, flat };
  bool wide = false;  // the whole width; else two charts stand side by side
  Height height = Height::usual;
};

struct Chart {
  std::string title;    // empty: it belongs to the one above, over the same abscissa
  std::string x_label;  // with unit
  std::string y_label;  // with unit
  std::string caption;  // what to look at
  bool logarithmic_x = false;
  std::vector<Series> series;
  std::optional<std::array<double, 2>> x_range{};  // what is shown first, of a longer record; none: all
  std::vector<double> levels{};                    // horizontal lines across the chart
  std::vector<Distance> distances{};
  std::optional<std::array<double, 2>> y_range{};  // what is shown; none: all of it
  double y_step = 0.0;                             // from tick to tick; 0: chosen by the page
  Shape shape{};
  bool same_scale = false;  // of both axes: a picture of a path
};

struct ExperimentResult {
  std::string experiment;             // "impact"
  std::string title;                  // "Impact compliance"
  std::string signals;                // "fixed", "double"; empty where no control takes part
  std::string question;               // what the source says the experiment must show
  std::vector<std::string> findings;  // sentences on what it did show
  std::vector<Figure> figures;
  std::vector<Chart> charts;
};

}  // namespace stiction::sim
