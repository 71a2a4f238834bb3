// Pieces of an HDF5 file as bytes, none of them taken from beyond its end. Internal to the trajectory.
#pragma once

#include "sim/trajectory/hdf5_calls.h"
#include "sim/trajectory/trajectory_file.h"

#include <string>
#include <string_view>

namespace sim::file {

inline constexpr std::uint64_t no_address = ~std::uint64_t{0};

/// A form of storage that HDF5 knows and this program does not.
struct Unread : Refused {
  using Refused::Refused;
};

/// Bob Jenkins' lookup3, with which HDF5 guards its metadata.
std::uint32_t metadata_checksum(std::string_view bytes);
void require_checksum(std::string_view bytes, std::uint64_t sum);

/// Bytes that are taken one after the other; Refused when there are no more.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}
  std::size_t left() const { return rest_.size(); }
  std::string_view bytes(std::uint64_t count);
  void skip(std::uint64_t count) { bytes(count); }
  std::uint64_t number(std::uint64_t count);  ///< little-endian, of at most 8 bytes

 private:
  std::string_view rest_;
};

/// Blocks of a file; Refused where they do not lie within it, and when they become more than any index has.
class Blocks {
 public:
  explicit Blocks(const Descriptor& file) : file_(file), file_bytes_(file.size()) {}
  std::string at(std::uint64_t address, std::uint64_t bytes);
  /// Bytes that are followed by their checksum, which fits.
  std::string sealed(std::uint64_t address, std::uint64_t bytes);

 private:
  const Descriptor& file_;
  std::uint64_t file_bytes_, rest_ = 32 << 20;
};

}  // namespace sim::file
