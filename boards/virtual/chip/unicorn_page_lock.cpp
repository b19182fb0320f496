// Makes stores of the emulated processor about three times faster with Unicorn 2.0.1.
//
// For every store to RAM that library collects the locks of the page in a newly allocated tree, although its
// page locks do nothing (it is single-threaded); later versions have dropped the calls. The library reaches
// these two functions through its procedure linkage table, so definitions in the program take their place.
// Should another version not do so, it uses its own: slower, never wrong.
#include "unicorn_page_lock.hpp"

extern "C" {

void* page_collection_lock_arm(void* /*engine*/, unsigned long /*first*/, unsigned long /*last*/);
void page_collection_unlock_arm(void* /*collection*/);

void* page_collection_lock_arm(void*, unsigned long, unsigned long) { return nullptr; }
void page_collection_unlock_arm(void*) {}
}

namespace inkwell::virtual_board {
void link_page_lock() {}
}  // namespace inkwell::virtual_board
