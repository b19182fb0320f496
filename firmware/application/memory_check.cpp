#include "firmware/application/memory_check.hpp"

#include <algorithm>
#include <array>

#include "firmware/application/memory.hpp"
#include "firmware/application/parts.hpp"
#include "firmware/application/vectors.hpp"

namespace inkwell::application {
namespace {

/// Each step checks only a few words, so that the main loop is not slowed down.
constexpr std::ptrdiff_t words_per_step = 4;

/// Start-up copies this memory range from the flash.
struct Copy {
  const std::uint32_t* begin;
  const std::uint32_t* end;
  const void* image;
};

const std::array<Copy, 3>& copies() {
  static constinit const std::array<Copy, 3> all{
      {{interrupt_text_begin, interrupt_text_end, interrupt_text_image},
       {interrupt_tables_begin, interrupt_tables_end, interrupt_tables_image},
       {interrupt_vectors, interrupt_vectors + sizeof vectors / sizeof(std::uint32_t), &vectors}}};
  return all;
}

}  // namespace

bool MemoryCheck::start() {
  checksum.start();
  begin_round();
  do static_cast<void>(step());
  while (intact_ && !(part_ == 0 && next_ == copied_begin));
  return intact_;
}

bool MemoryCheck::step() {
  if (!intact_) return false;
  if (part_ == 0)
    check_flash();
  else if (part_ <= copies().size())
    check_copy();
  else
    check_parameters();
  return intact_;
}

void MemoryCheck::begin_round() {
  part_ = 0;
  next_ = copied_begin;
  checksum.begin();
}

void MemoryCheck::check_flash() {
  const bool is_copied = next_ < copied_end;
  const std::uint32_t* const end = next_ + std::min(words_per_step, (is_copied ? copied_end : image_check) - next_);
  // The loop uses a local pointer, because GCC 12 writes the last word twice if the loop counter is a member.
  for (const std::uint32_t* word = next_; word != end; ++word) checksum.add(*word);
  next_ = is_copied && end == copied_end ? code_begin : end;  // the parameter store is between the copied code and the
                                                              // other code
  if (next_ != image_check) return;
  intact_ = checksum.value() == *image_check;
  next_ = copies()[0].begin;
  ++part_;
}

void MemoryCheck::check_copy() {
  const Copy& copy = copies()[part_ - 1];
  const auto* const image = static_cast<const std::uint32_t*>(copy.image);
  const std::uint32_t* const end = next_ + std::min(words_per_step, copy.end - next_);
  for (; next_ != end; ++next_) intact_ &= *next_ == image[next_ - copy.begin];
  if (next_ != copy.end) return;
  if (part_ < copies().size()) next_ = copies()[part_].begin;
  ++part_;
}

// Each step checks only one checksum, because a step must be short.
void MemoryCheck::check_parameters() {
  switch (part_++ - copies().size()) {
    case 1: intact_ = host_link.parameters.settings_are_intact(); break;
    case 2: intact_ = host_link.parameters.values_are_intact(); break;
    default: intact_ = host_link.stored.is_intact(); begin_round();
  }
}

}  // namespace inkwell::application
