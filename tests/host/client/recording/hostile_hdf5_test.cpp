// Each HDF5 file that differs from a recording is refused with a message.
#include <doctest/doctest.h>

#include <hdf5.h>

#include <cstddef>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "host/client/recording/recording.hpp"
#include "host/client/recording/writer.hpp"

#include "tests/failure.hpp"
#include "tests/temporary_directory.hpp"

using namespace inkwell;
using namespace inkwell::recording;
using inkwell::tests::contains;
using inkwell::tests::message_of;
using inkwell::tests::TemporaryDirectory;
using protocol::Signal;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t samples = 5000;
constexpr hsize_t huge = hsize_t{1} << 38;

Recording good_recording() {
  auto recording = Recording::without_samples({.created_utc = "2026-01-02T03:04:05Z",
                                               .firmware_version = "0.1.0",
                                               .serial_number = "0123456789ABCDEF01234567",
                                               .arm = "PHANTOM Omni",
                                               .parameters = protocol::default_parameters(),
                                               .signals = {Signal::force_x_N, Signal::force_y_N}});
  for (std::uint32_t i = 0; i < samples; ++i) {
    recording.periods.push_back(i);
    for (auto& column : recording.columns) column.push_back(0.5f * static_cast<float>(i));
  }
  recording.marks = {{3, "touch"}};
  return recording;
}

hid_t text_of(std::size_t bytes) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, bytes);
  return type;
}

hid_t compound() {
  const hid_t type = H5Tcreate(H5T_COMPOUND, 4096);
  H5Tinsert(type, "a", 0, H5T_NATIVE_FLOAT);
  return type;
}

hid_t column_of(hsize_t length) { return H5Screate_simple(1, &length, nullptr); }

hid_t table_of(hsize_t rows, hsize_t columns) {
  const hsize_t size[2] = {rows, columns};
  return H5Screate_simple(2, size, nullptr);
}

hid_t chunks_of(hsize_t length) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(properties, 1, &length);
  return properties;
}

/// Replaces an attribute of the file; the new attribute is filled with 'A'.
void put_attribute(hid_t file, const char* name, hid_t type, hid_t space) {
  if (H5Aexists(file, name) > 0) H5Adelete(file, name);
  const hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE(attribute >= 0);
  if (H5Tis_variable_str(type) == 0) {
    const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
    REQUIRE(H5Awrite(attribute, type, std::string(count * H5Tget_size(type), 'A').data()) >= 0);
  }
  H5Aclose(attribute);
}

/// Replaces a dataset of the file; the new dataset has no values.
void put_dataset(hid_t file, const char* path, hid_t type, hid_t space, hid_t properties = H5P_DEFAULT) {
  H5Ldelete(file, path, H5P_DEFAULT);
  const hid_t dataset = H5Dcreate2(file, path, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  REQUIRE(dataset >= 0);
  H5Dclose(dataset);
}

struct Spoilt {
  TemporaryDirectory directory;
  fs::path file = directory / "a.h5";

  Spoilt() { save(good_recording(), file); }

  /// Changes the file, reads it and returns the error message.
  std::string after(const std::function<void(hid_t)>& change) const {
    {
      const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
      H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
      const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, access);
      REQUIRE(opened >= 0);
      change(opened);
      H5Fclose(opened);
      H5Pclose(access);
    }
    return message_of<device::Error>([&] { read(file); });
  }
};

struct Case {
  const char* name;
  std::function<void(hid_t)> change;
  std::string sentence;
};

void check_each(const std::vector<Case>& cases) {
  for (const Case& each : cases) {
    CAPTURE(each.name);
    const std::string said = Spoilt().after(each.change);
    CAPTURE(said);
    CHECK(contains(said, "a.h5 is damaged: "));
    CHECK(contains(said, each.sentence));
    CHECK(contains(said, ". Nothing was loaded."));
  }
}

}  // namespace

TEST_CASE("an attribute must be one number or one text of bounded length") {
  const hid_t one = H5Screate(H5S_SCALAR);
  const hid_t wide = H5Tcopy(H5T_NATIVE_INT64);
  H5Tset_size(wide, 32);
  H5Tset_precision(wide, 256);
  check_each({
      {"an array in a number", [](hid_t f) { put_attribute(f, "format_version", H5T_NATIVE_INT64, column_of(1000)); },
       "format_version must have exactly one element"},
      {"a table in a number", [](hid_t f) { put_attribute(f, "simulation", H5T_NATIVE_INT64, table_of(1, 1)); },
       "simulation must have exactly one element"},
      {"nothing in a number", [](hid_t f) { put_attribute(f, "step_periods", H5T_NATIVE_INT64, H5Screate(H5S_NULL)); },
       "step_periods must have exactly one element"},
      {"a real number", [&](hid_t f) { put_attribute(f, "format_version", H5T_NATIVE_DOUBLE, one); },
       "format_version must be a whole number"},
      {"a number of 32 bytes", [&](hid_t f) { put_attribute(f, "format_version", wide, one); },
       "format_version must be a whole number"},
      {"a text in a number", [&](hid_t f) { put_attribute(f, "protocol_version", text_of(100), one); },
       "protocol_version must be a whole number"},
      {"a compound in a number", [&](hid_t f) { put_attribute(f, "format_version", compound(), one); },
       "format_version must be a whole number"},
      {"an array in a text", [](hid_t f) { put_attribute(f, "arm", text_of(16), column_of(100)); },
       "arm must have exactly one element"},
      {"a number in a text", [&](hid_t f) { put_attribute(f, "serial_number", H5T_NATIVE_INT64, one); },
       "serial_number must be a text of at most 65536 bytes"},
      {"a compound in a text", [&](hid_t f) { put_attribute(f, "force_law", compound(), one); },
       "force_law must be a text"},
  });
}

TEST_CASE("a text that is too long for an ordinary attribute is refused") {
  const TemporaryDirectory directory;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const hid_t file = H5Fcreate(directory.file("a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  REQUIRE(file >= 0);
  put_attribute(file, "format", text_of(100'000), H5Screate(H5S_SCALAR));
  H5Fclose(file);
  H5Pclose(access);
  CHECK(contains(message_of<device::Error>([&] { read(directory / "a.h5"); }), "format must be a text of at most"));
}

TEST_CASE("a text of variable length, as other programs write it, is left out with a remark") {
  const Spoilt spoilt;
  CHECK(spoilt.after([](hid_t f) { put_attribute(f, "arm", text_of(H5T_VARIABLE), H5Screate(H5S_SCALAR)); }).empty());
  const Recording recording = read(spoilt.file);
  CHECK(recording.information.arm.empty());
  REQUIRE(recording.remarks.size() == 1);
  CHECK(contains(recording.remarks[0], "The arm of "));
  CHECK(recording.size() == samples);
}

TEST_CASE("a scalar dataset must be one number of its class") {
  const hid_t one = H5Screate(H5S_SCALAR);
  const std::string stiffness = "/parameters/wall_stiffness_N_per_m";
  check_each({
      {"an array in the count of samples",
       [](hid_t f) { put_dataset(f, "/samples", H5T_NATIVE_INT64, column_of(1000)); },
       "/samples must have exactly one element"},
      {"a table", [](hid_t f) { put_dataset(f, "/complete", H5T_NATIVE_INT32, table_of(1, 1)); },
       "/complete must have exactly one element"},
      {"a real count", [&](hid_t f) { put_dataset(f, "/samples", H5T_NATIVE_DOUBLE, one); },
       "/samples must be a whole number"},
      {"a text as a count", [&](hid_t f) { put_dataset(f, "/complete", text_of(4000), one); },
       "/complete must be a whole number"},
      {"no count", [](hid_t f) { H5Ldelete(f, "/samples", H5P_DEFAULT); }, "it has no /samples"},
      {"a group as a count",
       [](hid_t f) {
         H5Ldelete(f, "/samples", H5P_DEFAULT);
         H5Gclose(H5Gcreate2(f, "/samples", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
       },
       "/samples cannot be read"},
      {"an array in a parameter",
       [&](hid_t f) { put_dataset(f, stiffness.c_str(), H5T_NATIVE_FLOAT, column_of(100'000)); },
       stiffness + " must have exactly one element"},
      {"a whole number in a parameter", [&](hid_t f) { put_dataset(f, stiffness.c_str(), H5T_NATIVE_INT64, one); },
       stiffness + " must be a real number"},
      {"a compound in a parameter", [&](hid_t f) { put_dataset(f, stiffness.c_str(), compound(), one); },
       stiffness + " must be a real number"},
      {"a long double in a parameter", [&](hid_t f) { put_dataset(f, stiffness.c_str(), H5T_NATIVE_LDOUBLE, one); },
       stiffness + " must be a real number"},
  });
}

TEST_CASE("a column must have one dimension, the right class, and enough data in the file") {
  const hid_t length = column_of(samples);
  const auto extend = [](hid_t f, const char* path) {
    const hid_t column = H5Dopen2(f, path, H5P_DEFAULT);
    REQUIRE(H5Dset_extent(column, &huge) >= 0);
    H5Dclose(column);
  };
  const auto many = [&](hid_t f) {
    const hid_t count = H5Dopen2(f, "/samples", H5P_DEFAULT);
    REQUIRE(H5Dwrite(count, H5T_NATIVE_HSIZE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &huge) >= 0);
    H5Dclose(count);
  };
  check_each({
      {"a table", [](hid_t f) { put_dataset(f, "/period", H5T_NATIVE_UINT32, table_of(2, samples)); },
       "/period must be a column"},
      {"one number", [](hid_t f) { put_dataset(f, "/signals/force_x_N", H5T_NATIVE_FLOAT, H5Screate(H5S_SCALAR)); },
       "/signals/force_x_N must be a column"},
      {"real periods", [&](hid_t f) { put_dataset(f, "/period", H5T_NATIVE_DOUBLE, length); },
       "/period must be whole numbers"},
      {"a whole signal", [&](hid_t f) { put_dataset(f, "/signals/force_x_N", H5T_NATIVE_INT32, length); },
       "/signals/force_x_N must be real numbers"},
      {"a signal of texts", [&](hid_t f) { put_dataset(f, "/signals/force_x_N", text_of(64), length); },
       "/signals/force_x_N must be real numbers"},
      {"a signal of compounds", [&](hid_t f) { put_dataset(f, "/signals/force_x_N", compound(), length); },
       "/signals/force_x_N must be real numbers"},
      {"a signal of lists",
       [&](hid_t f) { put_dataset(f, "/signals/force_x_N", H5Tvlen_create(H5T_NATIVE_FLOAT), length); },
       "/signals/force_x_N must be real numbers"},
      {"2^38 samples in chunks",
       [&](hid_t f) {
         many(f);
         for (const char* path : {"/period", "/signals/force_x_N", "/signals/force_y_N"}) extend(f, path);
       },
       "/period declares 274877906944 elements, more than 4294967296"},
      {"2^30 samples, none of them stored",
       [&](hid_t f) {
         many(f);
         for (const char* path : {"/signals/force_x_N", "/signals/force_y_N"}) extend(f, path);
         put_dataset(f, "/period", H5T_NATIVE_UINT32, column_of(1 << 30));
       },
       "/period declares 1073741824 elements, but the file does not contain them"},
      {"one column as two",
       [](hid_t f) {
         const char* const path = "/signals/force_x_N";
         put_dataset(f, path, H5T_NATIVE_FLOAT, column_of(500'000));
         const hid_t column = H5Dopen2(f, path, H5P_DEFAULT);
         const std::vector<float> values(500'000, 1.0f);
         REQUIRE(H5Dwrite(column, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
         H5Dclose(column);
         H5Ldelete(f, "/signals/force_y_N", H5P_DEFAULT);
         H5Lcreate_hard(f, path, f, "/signals/force_y_N", H5P_DEFAULT, H5P_DEFAULT);
       },
       "but the file does not contain them"},
      {"2^30 texts of marks",
       [](hid_t f) {
         put_dataset(f, "/marks/period", H5T_NATIVE_UINT32, column_of(1 << 30));
         put_dataset(f, "/marks/text", text_of(240), column_of(1 << 30));
       },
       "/marks/period declares 1073741824 elements"},
      {"a mark of 5000 bytes", [](hid_t f) { put_dataset(f, "/marks/text", text_of(5000), column_of(1)); },
       "/marks/text must be texts of at most 4096 bytes"},
      {"a mark of variable length", [](hid_t f) { put_dataset(f, "/marks/text", text_of(H5T_VARIABLE), column_of(1)); },
       "/marks/text must be texts"},
      {"marks with fewer clocks", [](hid_t f) { put_dataset(f, "/marks/clock_utc", text_of(24), column_of(0)); },
       "/marks/clock_utc has 0 elements where 1 are expected"},
      {"a table of marks", [](hid_t f) { put_dataset(f, "/marks/kind", text_of(16), table_of(1, 1)); },
       "/marks/kind must be a column"},
  });
}

TEST_CASE("values must lie in the file, in a form that needs no other library") {
  const TemporaryDirectory directory;
  const std::string other = directory.file("other.h5");
  save(good_recording(), other);
  const hid_t length = column_of(samples);
  const char* const signal = "/signals/force_x_N";
  const auto filtered = [](auto set) {
    const hid_t properties = chunks_of(1000);
    set(properties);
    return properties;
  };
  const std::string form = std::string(signal) + " has a storage format that recordings do not use";
  check_each({
      {"a soft link",
       [&](hid_t f) {
         H5Ldelete(f, signal, H5P_DEFAULT);
         H5Lcreate_soft("/signals/force_y_N", f, signal, H5P_DEFAULT, H5P_DEFAULT);
       },
       "/signals/force_x_N is a link to another object"},
      {"a link to another file's group",
       [&](hid_t f) {
         H5Ldelete(f, "/signals", H5P_DEFAULT);
         H5Lcreate_external(other.c_str(), "/signals", f, "/signals", H5P_DEFAULT, H5P_DEFAULT);
       },
       "/signals is a link to another object"},
      {"values of another file",
       [&](hid_t f) {
         const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
         H5Pset_external(properties, other.c_str(), 0, samples * sizeof(float));
         put_dataset(f, signal, H5T_NATIVE_FLOAT, length, properties);
       },
       form},
      {"a view of another file",
       [&](hid_t f) {
         const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
         H5Pset_virtual(properties, length, other.c_str(), signal, length);
         put_dataset(f, signal, H5T_NATIVE_FLOAT, length, properties);
       },
       form},
      {"a filter that packs without a limit",
       [&](hid_t f) { put_dataset(f, signal, H5T_NATIVE_FLOAT, length, filtered([](hid_t p) { H5Pset_nbit(p); })); },
       form},
      {"a chunk of a gigabyte",
       [&](hid_t f) {
         const hsize_t any = H5S_UNLIMITED, size = samples;
         put_dataset(f, signal, H5T_NATIVE_FLOAT, H5Screate_simple(1, &size, &any), chunks_of(1 << 28));
       },
       form},
  });
}

TEST_CASE("an HDF5 group must be a group, with unique names and a limited number of entries") {
  check_each({
      {"no signals", [](hid_t f) { H5Ldelete(f, "/signals", H5P_DEFAULT); }, "it has no /signals"},
      {"a number as a group", [](hid_t f) { put_dataset(f, "/parameters", H5T_NATIVE_FLOAT, H5Screate(H5S_SCALAR)); },
       "/parameters is not a group"},
      {"5000 parameters",
       [](hid_t f) {
         for (int i = 0; i < 5000; ++i)
           H5Lcreate_hard(f, "/samples", f, ("/parameters/p" + std::to_string(i)).c_str(), H5P_DEFAULT, H5P_DEFAULT);
       },
       " entries, more than 4096"},
  });

  const Spoilt spoilt;
  std::ifstream stream(spoilt.file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  for (auto at = bytes.find("force_y_N"); at != std::string::npos; at = bytes.find("force_y_N", at + 1))
    bytes.replace(at, 9, "force_x_N");
  std::ofstream(spoilt.file, std::ios::binary) << bytes;
  CHECK(contains(message_of<device::Error>([&] { read(spoilt.file); }), "/signals contains a name twice"));
}

TEST_CASE("a recording that another program has written again is read") {
  const Spoilt spoilt;
  CHECK(spoilt
            .after([](hid_t f) {
              put_dataset(f, "/signals/force_x_N", H5T_IEEE_F64BE, column_of(samples));
              const hid_t column = H5Dopen2(f, "/signals/force_x_N", H5P_DEFAULT);
              const std::vector<double> values(samples, 2.5);
              REQUIRE(H5Dwrite(column, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
              H5Dclose(column);
              put_attribute(f, "simulation", H5T_STD_I8LE, column_of(1));
            })
            .empty());
  const Recording recording = read(spoilt.file);
  CHECK(recording.complete);
  CHECK(recording.information.simulation);
  CHECK(recording.columns[0] == std::vector<float>(samples, 2.5f));
  CHECK(recording.columns[1][samples - 1] == 0.5f * (samples - 1));
}
