// The attributes of a trajectory, read without HDF5. libhdf5 (1.10 at least) decodes an attribute before it has checked
// that its parts end within its bytes, wherever they are stored, so a damaged file makes it read beyond a block.
// Internal to the trajectory.
#pragma once

#include "sim/trajectory/trajectory_file.h"

#include <map>
#include <string>
#include <string_view>

namespace sim::file {

/// Attributes of the root of a file that HDF5 has opened, whose superblock is therefore whole. They are found in the
/// object header (compact) or in a fractal heap with an index (dense: files of earlier versions).
class Attributes {
 public:
  explicit Attributes(const Descriptor&);

  bool has(std::string_view name) const { return all_.contains(name); }
  bool dense() const { return dense_; }
  /// Of one value, a text of a fixed length or an I64LE; anything else is Refused by its name.
  std::string text(const char* name) const;
  std::int64_t number(const char* name) const;

 private:
  enum class Kind { text, number, other };
  struct Attribute {
    Kind kind = Kind::other;
    std::string bytes;
  };
  std::map<std::string, Attribute, std::less<>> all_;
  bool dense_ = false;

  void add(std::string_view message);
  std::string_view bytes_of(const char* name, Kind) const;
};

}  // namespace sim::file
