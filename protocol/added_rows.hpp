// Rows of a force law at the end of the parameter and signal tables.
//
// A firmware image contains one force law and the rows of this force law. A PC program reads the rows of the force law
// from the device. Window, files and command line use added rows in the same way as table rows.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <span>

namespace inkwell::protocol {

/// Rows of the force law. A PC program sets `added_rows` when the program opens a device with a force law. The rows are
/// never freed or changed, because another thread may read the rows.
template <class Info>
inline constinit std::atomic<const std::span<const Info>*> added_rows = nullptr;

template <class Info>
inline constexpr Info nameless_row{};

/// Table with rows added at run time. `own` is the number of rows in the fixed table. Constant expressions use the
/// fixed table instead of this class.
///
/// The constructor must not call std::is_constant_evaluated(). GCC 14 evaluates std::is_constant_evaluated() to true if
/// a reference is bound to the new object. A range-based for loop would therefore omit the added rows.
template <class Info, std::size_t own>
class KnownRows {
 public:
  explicit KnownRows(const std::array<Info, own>& table) : table_(&table) {
    const auto* rows = added_rows<Info>.load(std::memory_order_acquire);
    if (rows != nullptr) added_ = *rows;
  }

  std::size_t size() const { return own + added_.size(); }
  /// Returns a row without a name if the index is out of range.
  const Info& operator[](std::size_t index) const {
    return index < own ? (*table_)[index] : index < size() ? added_[index - own] : nameless_row<Info>;
  }

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Info;
    using difference_type = std::ptrdiff_t;
    using pointer = const Info*;
    using reference = const Info&;

    Iterator(const KnownRows& rows, std::size_t index) : rows_(&rows), index_(index) {}
    const Info& operator*() const { return (*rows_)[index_]; }
    const Info* operator->() const { return &(*rows_)[index_]; }
    Iterator& operator++() {
      ++index_;
      return *this;
    }
    Iterator operator++(int) { return {*rows_, index_++}; }
    bool operator==(const Iterator&) const = default;

   private:
    const KnownRows* rows_;
    std::size_t index_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  const std::array<Info, own>* table_;
  std::span<const Info> added_;
};

}  // namespace inkwell::protocol
