// What somebody may do to a trajectory so that it stays an HDF5 file: attributes of other types and extents, datasets
// of other types, extents and storage, links that lead elsewhere. Each edit is made by HDF5 itself, so that all its
// checksums fit.
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

namespace support {

using Random = std::mt19937;

/// Errors are passed over: an edit that cannot be made is none.
class H5Quiet {
 public:
  H5Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  H5Quiet(const H5Quiet&) = delete;
  ~H5Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

template <class T>
const T& pick(const std::vector<T>& list, Random& random) {
  return list[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(random)];
}

inline hid_t text_of_bytes(std::size_t bytes) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, bytes);
  return type;
}

/// A type of any class; the caller closes it.
inline hid_t some_type(Random& random) {
  const hsize_t extent[] = {std::uniform_int_distribution<hsize_t>(1, 40)(random)};
  switch (std::uniform_int_distribution(0, 11)(random)) {
    case 0:
      return H5Tcopy(H5T_STD_I64LE);
    case 1:
      return H5Tcopy(H5T_STD_U64BE);
    case 2:
      return H5Tcopy(H5T_IEEE_F64LE);
    case 3:
      return H5Tcopy(H5T_IEEE_F32BE);
    case 4:
      return H5Tcopy(H5T_STD_I8LE);
    case 5:
      return text_of_bytes(H5T_VARIABLE);
    case 6:
      return text_of_bytes(std::uniform_int_distribution<std::size_t>(1, 5000)(random));
    case 7:
      return H5Tarray_create2(H5T_STD_I64LE, 1, extent);
    case 8:
      return H5Tvlen_create(H5T_STD_I64LE);
    case 9:
      return H5Tcreate(H5T_OPAQUE, extent[0]);
    case 10:
      return H5Tcopy(H5T_STD_REF_OBJ);
    default: {
      const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
      H5Tinsert(type, "a", 0, H5T_STD_I64LE);
      H5Tinsert(type, "b", 8, H5T_IEEE_F64LE);
      return type;
    }
  }
}

inline hid_t some_space(Random& random) {
  const int rank = std::uniform_int_distribution(-1, 3)(random);
  if (rank < 1) return H5Screate(rank < 0 ? H5S_NULL : H5S_SCALAR);
  std::array<hsize_t, 3> extent{};
  for (hsize_t& e : extent) e = std::uniform_int_distribution<hsize_t>(0, rank == 1 ? 1000 : 12)(random);
  return H5Screate_simple(rank, extent.data(), nullptr);
}

/// An attribute of the same name; its bytes are all 0x41. Sizes that HDF5 cannot hold leave none.
inline void replace_attribute(hid_t object, const std::string& name, hid_t type, hid_t space) {
  H5Adelete(object, name.c_str());
  const hid_t attribute = H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
  if (attribute < 0) return;
  const H5T_class_t kind = H5Tget_class(type);
  const bool plain = kind != H5T_VLEN && kind != H5T_REFERENCE && H5Tis_variable_str(type) <= 0;
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  const std::vector<char> bytes(H5Tget_size(type) * static_cast<std::size_t>(std::max<hssize_t>(points, 0)) + 1, 'A');
  if (plain && points > 0) H5Awrite(attribute, type, bytes.data());
  H5Aclose(attribute);
}

enum class Storage { contiguous, chunked, compact, external, virtual_source };

/// A dataset in the place of another.
inline void replace_dataset(hid_t file, const std::string& name, hid_t type, hid_t space, Storage storage,
                            const std::string& elsewhere) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
  const int rank = H5Sget_simple_extent_ndims(space);
  const std::array<hsize_t, 3> ones{1, 1, 1};
  if (storage == Storage::chunked) H5Pset_chunk(plan, rank, ones.data());
  if (storage == Storage::compact) H5Pset_layout(plan, H5D_COMPACT);
  if (storage == Storage::external) H5Pset_external(plan, elsewhere.c_str(), 0, H5F_UNLIMITED);
  if (storage == Storage::virtual_source) H5Pset_virtual(plan, space, elsewhere.c_str(), "data", space);
  if (storage == Storage::contiguous) H5Pset_alloc_time(plan, H5D_ALLOC_TIME_EARLY);
  const hid_t dataset = H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
  if (dataset >= 0) H5Dclose(dataset);
  H5Pclose(plan);
}

/// A link in the place of another: to another file, to another name, or to the group above.
inline void replace_link(hid_t file, const std::string& name, int kind, const std::string& elsewhere) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  if (kind == 0) H5Lcreate_external(elsewhere.c_str(), "/data", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  if (kind == 1) H5Lcreate_soft(("/" + name).c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  if (kind == 2) H5Lcreate_hard(file, "/", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  if (kind == 3) H5Lcreate_hard(file, "velocity", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
}

inline std::vector<std::string> names_of_attributes(hid_t file) {
  std::vector<std::string> names;
  H5Aiterate2(
      file, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
        static_cast<std::vector<std::string>*>(list)->emplace_back(name);
        return 0;
      },
      &names);
  return names;
}

/// Of the heap outside the header of an object in which its attributes are; 0: they are in the header.
inline hsize_t bytes_of_attribute_heap(hid_t object) {
#if H5_VERSION_GE(1, 12, 0)
  H5O_native_info_t info{};
  H5Oget_native_info(object, &info, H5O_NATIVE_INFO_META_SIZE);
#else
  H5O_info_t info{};
  H5Oget_info2(object, &info, H5O_INFO_META_SIZE);
#endif
  return info.meta_size.attr.heap_size;
}

inline std::vector<std::string> names_of_datasets() {
  return {"count",   "steps/count", "notes_count", "resume_head", "checksum",  "steps/checksum", "scene",
          "notes",   "resume",      "step",        "time",        "order",     "label_order",    "tracers",
          "tension", "labels",      "position",    "steps",       "steps/time"};
}

/// One edit at random; `elsewhere` is what links and external storage lead to.
inline void hostile_edit(hid_t file, const std::string& elsewhere, Random& random) {
  const H5Quiet quiet;
  const std::vector<std::string> attributes = names_of_attributes(file);
  const std::string dataset = pick(names_of_datasets(), random);
  const hid_t type = some_type(random), space = some_space(random);
  switch (std::uniform_int_distribution(0, 5)(random)) {
    case 0:
    case 1:
    case 2:
      if (!attributes.empty()) replace_attribute(file, pick(attributes, random), type, space);
      break;
    case 3:
    case 4: {
      // Of the type and extent that there were, or others.
      const hid_t old = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
      const bool alike = old >= 0 && random() % 2 == 0;
      const hid_t same_type = alike ? H5Dget_type(old) : H5Tcopy(type),
                  same_space = alike ? H5Dget_space(old) : H5Scopy(space);
      if (old >= 0) H5Dclose(old);
      replace_dataset(file, dataset, same_type, same_space, static_cast<Storage>(random() % 5), elsewhere);
      H5Tclose(same_type);
      H5Sclose(same_space);
      break;
    }
    default:
      replace_link(file, dataset, static_cast<int>(random() % 4), elsewhere);
  }
  H5Tclose(type);
  H5Sclose(space);
}

}  // namespace support
