// Rows that the force law of a device adds to the tables of parameters and signals, behind their last.
//
// The firmware knows its own law. A PC program learns of it from the device that it opens, and from then on the rows
// are in the tables like all others: in the window, in files, on the command line.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <span>

namespace inkwell::protocol {

/// Set whenever a PC program meets a force law. What it points at stays as it is for ever, since another thread may
/// still read it.
template <class Info>
inline constinit std::atomic<const std::span<const Info>*> added_rows = nullptr;

template <class Info>
inline constexpr Info nameless_row{};

/// A table with the rows that are added to it at run time; `own` is the number of its own rows. Constant expressions
/// read the table itself. The constructor must not ask std::is_constant_evaluated(): GCC 14 answers true wherever a
/// reference is bound to the result, as in a range-based for loop, and the added rows would be missing there.
template <class Info, std::size_t own>
class KnownRows {
 public:
  explicit KnownRows(const std::array<Info, own>& table) : table_(&table) {
    const auto* rows = added_rows<Info>.load(std::memory_order_acquire);
    if (rows != nullptr) added_ = *rows;
  }

  std::size_t size() const { return own + added_.size(); }
  /// A row without a name for a place that no row has.
  const Info& operator[](std::size_t place) const {
    return place < own ? (*table_)[place] : place < size() ? added_[place - own] : nameless_row<Info>;
  }

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Info;
    using difference_type = std::ptrdiff_t;
    using pointer = const Info*;
    using reference = const Info&;

    Iterator(const KnownRows& rows, std::size_t place) : rows_(&rows), place_(place) {}
    const Info& operator*() const { return (*rows_)[place_]; }
    const Info* operator->() const { return &(*rows_)[place_]; }
    Iterator& operator++() {
      ++place_;
      return *this;
    }
    Iterator operator++(int) { return {*rows_, place_++}; }
    bool operator==(const Iterator&) const = default;

   private:
    const KnownRows* rows_;
    std::size_t place_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  const std::array<Info, own>* table_;
  std::span<const Info> added_;
};

}  // namespace inkwell::protocol
