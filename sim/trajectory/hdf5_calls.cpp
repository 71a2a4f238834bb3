#include "sim/trajectory/hdf5_calls.h"

#include <algorithm>
#include <cstring>

namespace sim::file {

hid_t checked(hid_t id, const char* what) {
  if (id < 0) throw Refused(what);
  return id;
}

void start_hdf5() {
  [[maybe_unused]] static const herr_t first = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5Eclear2(H5E_DEFAULT);
  H5PLset_loading_state(0);
}

hid_t text_type(std::uint64_t bytes) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, bytes);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

bool is_text(hid_t type) { return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0; }

namespace {

void write_attribute(hid_t object, const char* name, hid_t type, const void* value) {
  Making made;
  const hid_t attribute =
      made(H5Acreate2(object, name, type, made(H5Screate(H5S_SCALAR), H5Sclose), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  Making::check(H5Awrite(attribute, type, value));
  made.close();
}

/// The one way in which HDF5 copies anything out of a file: an attribute of one value. Type, extent and size are what
/// the caller expects before a byte is copied. A type below 0 stands for a text of a fixed length.
std::string read_attribute(hid_t object, const char* name, hid_t expected, std::uint64_t largest) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, name);
  const Handle space(H5Aget_space(attribute), H5Sclose, name);
  const std::uint64_t size = H5Tget_size(type);
  if (H5Sget_simple_extent_type(space) != H5S_SCALAR ||
      !(expected < 0 ? is_text(type) : H5Tequal(type, expected) > 0) || size == 0 || size > largest ||
      H5Aget_storage_size(attribute) != size)
    throw Refused(name);
  std::string bytes(size, '\0');
  if (H5Aread(attribute, type, bytes.data()) < 0) throw Refused(name);
  return bytes;
}

}  // namespace

void write_text(hid_t object, const char* name, const std::string& text) {
  Making made;
  write_attribute(object, name, made(text_type(std::max<std::size_t>(text.size(), 1)), H5Tclose), text.c_str());
  made.close();
}

void write_number(hid_t object, const char* name, std::int64_t value) {
  write_attribute(object, name, H5T_STD_I64LE, &value);
}

std::string read_text(hid_t object, const char* name, std::uint64_t file_bytes) {
  constexpr std::uint64_t largest_text = 16 << 20;  // more than any program writes
  std::string text = read_attribute(object, name, H5I_INVALID_HID, std::min(largest_text, file_bytes));
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::int64_t read_number(hid_t object, const char* name) {
  std::int64_t value = 0;
  const std::string bytes = read_attribute(object, name, H5T_STD_I64LE, sizeof value);
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

}  // namespace sim::file
