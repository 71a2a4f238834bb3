// The two halves of a transform between coefficients and a Gauss-Legendre x uniform grid, as products of small constant
// matrices with rows of whole SIMD vectors: latitudes are the lanes. Longitudes fall into orbits {f, -f, pi-f, pi+f} of
// a quarter, under whose mirrors cosines and sines of even and odd m are even or odd: a quarter of the Fourier products
// is left, and derivatives in phi need no other spectra, since d/dphi only exchanges the two kinds.
#pragma once

#include "sim/core/lanes.h"
#include "sim/sphere/legendre.h"

#include <array>

namespace sim {

/// Which of the functions P (0), P' (1), P'' (2) of the latitude are wanted: [first, last).
struct TableRange {
  int first = 0, last = 0;
  int count() const { return last - first; }
};

/// Samples that are wanted of a transform: for each derivative in phi the functions of the latitude, and where the
/// samples of all fields go, points x fields, latitude fastest.
struct Wanted {
  TableRange tables[3];
  double* out[3][3] = {};  ///< [derivative in phi][derivative in theta]
};

/// Plan for degree p on a grid. A spectrum is [row][table][field][latitude vectors], row m being the cosine of m phi
/// and p + m the sine. Vectors are those of whole latitudes: the first ones from the north, as many from the south,
/// whose lanes are mirrors of theirs, since P_nm is even or odd in z as n - m is, and one or two between them. These
/// overlap their southern neighbours where latitudes do not fill them.
class GridTransform {
 public:
  /// `dense`: with the tables of the Fourier half.
  GridTransform(int order, const GaussLegendre&, int longitudes, bool dense);

  int latitude_lanes() const { return lanes_; }
  /// Between a row of vectors and the latitudes in their order.
  Vector latitudes_of(const Lane* row) const;
  void set_latitudes(const Vector& values, Lane* row) const;
  Eigen::Index spectrum_size(int columns) const { return Eigen::Index(2 * p_ + 1) * columns * lanes_; }

  /// Legendre synthesis of coefficients (column-major, (degree+1)^2 rows a field) with the functions of a range.
  void along_latitudes(const double* coefficients, int degree, int fields, TableRange, Lane* spectrum) const;
  /// Fourier synthesis from the spectra of the range `made`, which contains all that is wanted.
  void around(const Lane* spectrum, int degree, int fields, TableRange made, const Wanted&) const;
  /// Fourier analysis of samples, points x fields, without the factor 2 pi / longitudes.
  void spectrum_of(const double* samples, int fields, Lane* spectrum) const;
  /// Legendre analysis with Gauss weights and that factor: (p+1)^2 x fields.
  void project(const Lane* spectrum, int fields, double* coefficients) const;

 private:
  int orbits() const { return nlon_ / 4 + 1; }
  /// Where a vector of latitudes starts.
  int first_latitude(int vector) const {
    return vector <= mirrored_ ? vector * lanes : nlat_ - (lanes_ - vector) * lanes;
  }
  /// How many of its lanes are latitudes: all, but on the smallest grids.
  int kept() const { return nlat_ < lanes ? nlat_ : lanes; }

  int p_, nlat_, nlon_;
  int lanes_, mirrored_, made_;                 ///< vectors: all, those of the north, and with the middle ones
  std::array<LaneBuffer, 3> legendre_;          ///< [m][n][vector], those that are made
  LaneBuffer weighted_;                         ///< likewise, with weights; 0 where another vector has the latitude
  std::array<std::vector<double>, 3> fourier_;  ///< [derivative][orbit][row]
  /// Of degree n = m among the rows of a Legendre table.
  Eigen::Index first_of(int m) const { return legendre_index(p_, m, m); }
};

}  // namespace sim
