#include "plain_stores.hpp"

#include <dlfcn.h>

extern "C" void tlb_set_page_with_attrs_arm(void* processor, std::uint32_t address, std::uint64_t physical,
                                            std::uint64_t attributes, int rights, int index, std::uint32_t bytes);

namespace inkwell::virtual_board {
namespace {

thread_local PlainStores* in_use = nullptr;

/// Functions of the engine, null if this version has none of the name.
struct Engine {
  using PageFunction = void(void* processor, std::uint32_t address);
  template <class Function>
  static Function* find(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
  }
  decltype(&tlb_set_page_with_attrs_arm) set_page =
      find<decltype(tlb_set_page_with_attrs_arm)>("tlb_set_page_with_attrs_arm");
  PageFunction* mark_plain = find<PageFunction>("tlb_set_dirty_arm");
  PageFunction* forget_page = find<PageFunction>("tlb_flush_page_arm");
};

const Engine& engine() {
  static const Engine functions;
  return functions;
}

}  // namespace

bool PlainStores::plain(std::uint32_t address) const {
  if (address - ccm_base < ccm_bytes) return true;  // not on the instruction bus
  const std::uint32_t offset = address - sram_base;
  return offset < sram_bytes && !holds_code_[offset / page_bytes];
}

void PlainStores::code_runs_at(std::uint32_t address, std::uint32_t bytes) {
  const std::uint32_t end = address + bytes;
  for (std::uint32_t page = address - address % page_bytes; page < end; page += page_bytes) {
    const std::uint32_t offset = page - sram_base;
    if (offset >= sram_bytes || holds_code_[offset / page_bytes]) continue;
    holds_code_.set(offset / page_bytes);
    if (processor_ == nullptr) continue;
    for (std::uint32_t part = 0; part < page_bytes; part += smallest_page_bytes)
      engine().forget_page(processor_, page + part);
  }
}

PlainStores::Use::Use(PlainStores& stores) { in_use = &stores; }
PlainStores::Use::~Use() { in_use = nullptr; }

}  // namespace inkwell::virtual_board

// The attributes of an access are a structure that fits one register.
void tlb_set_page_with_attrs_arm(void* processor, std::uint32_t address, std::uint64_t physical,
                                 std::uint64_t attributes, int rights, int index, std::uint32_t bytes) {
  using namespace inkwell::virtual_board;
  engine().set_page(processor, address, physical, attributes, rights, index, bytes);
  if (in_use == nullptr || engine().mark_plain == nullptr || engine().forget_page == nullptr) return;
  in_use->remember_processor(processor);
  if (in_use->plain(address)) engine().mark_plain(processor, address);
}
