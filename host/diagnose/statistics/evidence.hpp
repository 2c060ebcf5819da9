// The regressors of all candidates over blocks of rows, and what any choice of them explains: from the blocks' scalar
// products of the whitened rows, so that few choices cost a pass over the rows. A block is one piece of evidence
// (Cameron, Gelbach, Miller 2008).
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "host/diagnose/statistics/block_products.hpp"
#include "host/diagnose/statistics/whitening.hpp"
#include "host/identify/regression.hpp"

namespace stiction::host {

using ColumnIndices = std::vector<Eigen::Index>;

class Evidence {
 public:
  // `target`: the residual force in all rows (N).
  Evidence(Eigen::VectorXd target, std::vector<RowBlock> blocks);

  // Appends columns. Returns the index of the first.
  Eigen::Index add(const std::vector<Eigen::VectorXd>& columns);
  // Drops all columns from `first` on.
  void truncate(Eigen::Index first);
  // Leaves the columns `kept`, in this order.
  void keep(const ColumnIndices& kept);
  // Looks at target and columns through `whitening` from now on; without it, as they are. `correlated`: rows that
  // belong together still: the clusters of covariances are no shorter (0: whole blocks).
  void whiten(Whitening whitening, std::size_t correlated = 0);

  // Looks at another target (N, in all rows) in the place of this one, through the same whitening.
  void retarget(Eigen::VectorXd target);

  std::size_t rows() const { return static_cast<std::size_t>(target_.size()); }
  Eigen::Index columns() const { return static_cast<Eigen::Index>(columns_.size()); }
  std::size_t blocks() const { return blocks_.size(); }
  const std::vector<RowBlock>& row_blocks() const { return blocks_; }
  double total() const { return white_.total(of_target, of_target); }  // sum of squares of the whitened target
  double column_square(Eigen::Index column) const { return product(column, column); }
  // Whitened: of two columns, and of a column with the target.
  double product(Eigen::Index one, Eigen::Index other) const { return white_.total(place(one), place(other)); }
  double moment(Eigen::Index column) const { return white_.total(of_target, place(column)); }
  // Works out together what these will be asked for: of the columns `some`, with each other, the target and `others`.
  void ask_for(const ColumnIndices& some, const ColumnIndices& others) const;
  const Eigen::VectorXd& target() const { return target_; }  // not whitened
  const Whitening& whitening() const { return whitening_; }

  struct Fit {
    Eigen::VectorXd coefficients;
    double left = 0.0;  // sum of squared residuals, whitened
  };
  Fit fit(const ColumnIndices& chosen) const;
  // Over the blocks for which use[b] is true.
  Fit fit(const ColumnIndices& chosen, const std::vector<bool>& use) const;
  // N, not whitened.
  Eigen::VectorXd residual(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const;

  // Sandwich covariance of the weights, by clusters of rows.
  Eigen::MatrixXd covariance(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const;
  // Cluster jackknife (CR3: MacKinnon, Nielsen, Webb, J. Econometrics 232, 2023, eq. 14): by how much the weights move
  // when a cluster is left out. Where a few clusters bear on a weight the sandwich calls it better known than it is.
  struct Jackknife {
    Eigen::MatrixXd covariance;
    Eigen::VectorXd clusters;  // effective number that bear on each weight (Carter, Schnepel, Steigerwald, Rev. Econ.
                               // Stat. 99, 2017), were the noise even
  };
  Jackknife jackknife(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const;
  // The jackknife's, so wide that 1.96 standard errors are the 95 % interval of Student's t with those clusters. Of few
  // clusters a spread is itself uncertain: on whitened rows no error is smaller than that of even noise (Angrist,
  // Pischke, Mostly Harmless Econometrics, 2009, 8.1).
  Eigen::MatrixXd interval_covariance(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const;
  struct Test {
    double wald = 0.0;  // over the number of columns
    double p_value = 1.0;
  };
  // That the weights first .. first + count - 1 are zero. Of whitened rows the covariance by clusters is drawn to that
  // of even noise by as much as the noise is even (moderated F: Smyth, Stat. Appl. Genet. Mol. Biol. 3, 2004).
  // `chosen`: indices of columns; `coefficients`: their weights.
  Test test(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients, Eigen::Index first,
            Eigen::Index count) const;
  // Number of clusters that bear on the columns `of` with these weights: (sum h)^2 / sum h^2 of their squared lengths.
  double bearing_clusters(const ColumnIndices& of, const Eigen::VectorXd& coefficients) const;

  // Square of the columns' force with these weights in each block.
  std::vector<double> bearing(const ColumnIndices& of, const Eigen::VectorXd& coefficients) const;

  // A column as it was `added`.
  const Eigen::VectorXd& column(Eigen::Index added) const { return columns_[static_cast<std::size_t>(added)]; }

  // Sum of squared residuals of each block with weights from the other folds; block i is in fold i mod `folds`.
  std::vector<double> held_out(const ColumnIndices& chosen, std::size_t folds = 5) const;

 private:
  // Of some columns, over some rows.
  struct Sums {
    Eigen::MatrixXd gram;
    Eigen::VectorXd moment;
    double square = 0.0;
  };
  struct Noise {
    double variance, freedom;
  };
  std::vector<double> bearing(const ColumnIndices& of, const Eigen::VectorXd& coefficients,
                              std::span<const RowBlock> pieces) const;
  Noise noise(const Eigen::VectorXd& left) const;
  Eigen::MatrixXd inverse_gram(const ColumnIndices& chosen) const;
  static Fit solve(const Sums& sums);
  static double left(const Sums& sums, const Eigen::VectorXd& coefficients);
  template <class Each>
  static void for_pairs(const ColumnIndices& chosen, Each&& each);
  Sums total_of(const ColumnIndices& chosen) const;
  std::vector<Sums> by_block(const ColumnIndices& chosen) const;
  Eigen::MatrixXd white(const ColumnIndices& chosen) const;
  const Eigen::VectorXd& white_target() const { return white_.column(of_target); }
  // Of a column in white_.
  static std::size_t place(Eigen::Index column) { return static_cast<std::size_t>(column) + 1; }
  // Of the target and of columns.
  static std::vector<std::size_t> places(const ColumnIndices& columns);
  static constexpr std::size_t of_target = 0;

  Eigen::VectorXd target_;
  std::vector<RowBlock> blocks_, clusters_;
  Whitening whitening_;
  std::vector<Eigen::VectorXd> columns_;
  BlockProducts white_;  // target and columns, whitened
};

}  // namespace stiction::host
