#include "host/diagnose/spectrum/place_scan.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host {
namespace {

constexpr double widest = 10.0;            // the stroke over it
constexpr int widths = 6;                  // each half as wide as the one before
constexpr int steps = 4;                   // of a foot: between two places that are tried
constexpr std::size_t tried_exactly = 6;   // of each width, with columns that are whitened
constexpr double bins_of_narrowest = 8.0;  // over a foot

// Sums over position up to each bin: of a quantity, and of it times the bin's number.
class RunningSums {
 public:
  explicit RunningSums(const std::vector<double>& bins) : zeroth_(bins.size() + 1, 0.0), first_(bins.size() + 1, 0.0) {
    for (std::size_t b = 0; b < bins.size(); ++b) {
      zeroth_[b + 1] = zeroth_[b] + bins[b];
      first_[b + 1] = first_[b] + bins[b] * static_cast<double>(b);
    }
  }
  // Of the quantity times a triangle of height 1 over `foot` bins to either side of bin `at`.
  double triangle(long at, long foot) const {
    const auto share = [&](long begin, long end, double sign) {  // 1 + sign (b - at) / foot, over bins begin to end
      const auto n = static_cast<long>(zeroth_.size()) - 1;
      const auto i = static_cast<std::size_t>(std::clamp(begin, 0L, n));
      const auto j = static_cast<std::size_t>(std::clamp(end, 0L, n));
      const double sum = zeroth_[j] - zeroth_[i], moment = first_[j] - first_[i];
      return sum + sign * (moment - static_cast<double>(at) * sum) / static_cast<double>(foot);
    };
    return share(at - foot + 1, at, 1.0) + share(at, at + foot, -1.0);
  }

 private:
  std::vector<double> zeroth_, first_;
};

struct Tried {
  Place place;
  double score;
};

double triangle(double x, const Place& place) { return std::max(1.0 - std::abs(x - place.at) / place.foot, 0.0); }

// What the triangle takes off the whitened residual's square.
double taken(const Eigen::VectorXd& position, const Eigen::VectorXd& carrier, const Eigen::VectorXd& white,
             const Whitening& whitening, const Place& place) {
  Eigen::VectorXd column(position.size());
  for (Eigen::Index i = 0; i < column.size(); ++i) column[i] = carrier[i] * triangle(position[i], place);
  const Eigen::VectorXd own = whitening(column);
  const double square = own.squaredNorm();
  return square > 0.0 ? std::pow(own.dot(white), 2) / square : 0.0;
}

}  // namespace

void scan_places(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                 const Eigen::VectorXd& carrier, double lowest, double highest, PlaceScan& scan) {
  scan.first_new = scan.places.size();
  const double stroke = highest - lowest;
  if (!(stroke > 0.0)) return;
  const double bin = stroke / (widest * std::pow(2.0, widths - 1) * bins_of_narrowest);
  const auto count = static_cast<std::size_t>(stroke / bin) + 1;
  const Eigen::VectorXd position = rows.stacked([](const Motion& motion) { return motion.x; });
  const Eigen::VectorXd white = whitening(residual), back = whitening.transposed(white);
  std::vector<double> moments(count, 0.0), squares(count, 0.0);
  for (Eigen::Index i = 0; i < position.size(); ++i) {
    const auto b =
        static_cast<std::size_t>(std::clamp((position[i] - lowest) / bin, 0.0, static_cast<double>(count - 1)));
    moments[b] += carrier[i] * back[i];
    squares[b] += carrier[i] * carrier[i];
  }
  const RunningSums moment(moments), square(squares);
  scan.trials = 0.0;
  for (int w = 0; w < widths; ++w) {
    const double parts = widest * std::pow(2.0, w), foot = stroke / parts;
    const long in_bins = std::lround(foot / bin);
    scan.trials += parts;
    std::vector<Tried> all;
    for (long at = 0; at < static_cast<long>(count); at += std::max(in_bins / steps, 1L))
      if (const double under = square.triangle(at, in_bins); under > 0.0)
        all.push_back({{lowest + (static_cast<double>(at) + 0.5) * bin, foot},
                       std::pow(moment.triangle(at, in_bins), 2) / under});
    std::sort(all.begin(), all.end(), [](const Tried& a, const Tried& b) { return a.score > b.score; });
    all.resize(std::min(all.size(), tried_exactly));
    for (auto& each : all) each.score = taken(position, carrier, white, whitening, each.place);
    const auto best =
        std::max_element(all.begin(), all.end(), [](const Tried& a, const Tried& b) { return a.score < b.score; });
    if (best != all.end() && std::find(scan.places.begin(), scan.places.end(), best->place) == scan.places.end())
      scan.places.push_back(best->place);
  }
}

}  // namespace stiction::host
