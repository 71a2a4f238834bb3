#include "sim/trajectory/hdf5_calls.h"

#include <algorithm>

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

}  // namespace

void write_text(hid_t object, const char* name, const std::string& text) {
  Making made;
  write_attribute(object, name, made(text_type(std::max<std::size_t>(text.size(), 1)), H5Tclose), text.c_str());
  made.close();
}

void write_number(hid_t object, const char* name, std::int64_t value) {
  write_attribute(object, name, H5T_STD_I64LE, &value);
}

}  // namespace sim::file
