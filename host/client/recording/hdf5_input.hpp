// The only interface that reads HDF5 files. HDF5 copies any declared amount of data into the given memory. Before
// reading a dataset or an attribute, the functions therefore check its class, type, rank, size and number of elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/client/recording/hdf5_file.hpp"

namespace inkwell::recording {

/// Every function throws device::Error if the file is damaged. The caller must own a QuietHdf5.
class Hdf5Input {
 public:
  /// An open dataset that was checked.
  struct Dataset {
    std::string path;
    Handle itself, type, space;
    bool is_compressed = false;
  };

  /// The index of a long recording takes several megabytes for each column. It must stay in memory while a writer
  /// extends the file, because the writer changes the index.
  enum class Index { may_be_dropped, stays };
  explicit Hdf5Input(const std::filesystem::path& file, Index index = Index::may_be_dropped);
  /// Reads the content of a file from memory. `name` is the file's name in error sentences.
  Hdf5Input(std::span<const std::byte> content, std::string name);

  const std::string& name() const { return name_; }
  bool has(const std::string& path) const;

  /// Returns a file attribute. Returns an empty text if the attribute is missing, and std::nullopt if the text has
  /// variable length.
  std::optional<std::string> text_attribute(const char* name) const;
  /// Returns 0 if the attribute is missing.
  std::int64_t number_attribute(const char* name) const;

  /// Names in a group, in alphabetical order. Names longer than 127 bytes are truncated.
  std::vector<std::string> names_in(const std::string& group) const;

  std::int64_t whole_number(const std::string& path) const;
  float real_number(const std::string& path) const;

  /// Declared number of elements in a column.
  std::uint64_t length_of(const std::string& column) const;
  /// Opens a column of at least `count` numbers, so that parts of the column can be read.
  Dataset whole_number_column(const std::string& column, std::uint64_t count);
  Dataset real_number_column(const std::string& column, std::uint64_t count);
  /// Reads numbers from the element `begin` on.
  void read(const Dataset& column, std::uint64_t begin, std::span<std::int64_t> numbers) const;
  void read(const Dataset& column, std::uint64_t begin, std::span<float> numbers) const;
  /// Returns the first `count` elements of a column.
  std::vector<std::int64_t> whole_numbers(const std::string& column, std::uint64_t count);
  std::vector<std::string> texts(const std::string& column, std::uint64_t count);

  [[noreturn]] void fail(const std::string& what) const;

 private:
  void check_is_here(const std::string& path) const;
  void check_one_element(hid_t space, const std::string& path) const;
  Handle open_attribute(const char* name) const;
  Dataset open(const std::string& path) const;
  Dataset open_column(const std::string& path) const;
  void check_content(const Dataset& column, std::uint64_t count);
  void read_scalar(const Dataset& dataset, hid_t type, void* value) const;
  void read_column(const Dataset& column, hid_t type, std::uint64_t begin, std::uint64_t count, void* values) const;

  std::string name_;
  Handle file_;
  std::uint64_t bytes_left_ = 0;  ///< bytes of the file for columns that are not read yet
};

}  // namespace inkwell::recording
