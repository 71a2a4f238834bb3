// What HDF5 is asked for, every answer checked: identifiers that close themselves, files in the making, attributes of
// one value. Internal to the trajectory.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sim::file {

/// What HDF5 refused, or a part of a file that is not what it must be; the sentence is made where the path is known.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The identifier, or Refused.
hid_t checked(hid_t id, const char* what);

/// An HDF5 identifier that is read from; closing it can lose nothing.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t), const char* what) : id_(checked(id, what)), close_(closer) {}
  Handle(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Identifiers of a file that is being made. Every call is checked, the closing ones too. Where one failed, nothing
/// more is asked of HDF5 about that file, not even to close it: libhdf5 crashes over what a failed call has left half
/// done.
class Making {
 public:
  hid_t operator()(hid_t id, herr_t (*closer)(hid_t)) {
    open_.emplace_back(checked(id, "HDF5 refused a call"), closer);
    return id;
  }
  void close() {
    for (; !open_.empty(); open_.pop_back()) check(open_.back().second(open_.back().first));
  }
  static void check(herr_t status) { checked(status, "HDF5 could not write"); }

 private:
  std::vector<std::pair<hid_t, herr_t (*)(hid_t)>> open_;
};

/// Before each use of HDF5. It says nothing by itself, loads no plugin that a file asks for, and leaves what is open
/// alone when the program ends.
void start_hdf5();

hid_t text_type(std::uint64_t bytes);  ///< of a fixed length, padded with zeros
bool is_text(hid_t type);

/// Attributes of one value.
void write_text(hid_t object, const char* name, const std::string& text);
void write_number(hid_t object, const char* name, std::int64_t value);

}  // namespace sim::file
