#include "host/contact/publication.hpp"

#include <utility>

namespace inkwell::contact {

Publication::~Publication() {
  free_list(pending_.load());
  free_list(retired_.load());
  free_list(current_);
}

void Publication::publish(std::shared_ptr<const Scene> scene) {
  // An entry that the servo thread has not taken yet is freed here.
  free_list(pending_.exchange(new Entry{std::move(scene)}));
  free_retired();
}

void Publication::free_retired() { free_list(retired_.exchange(nullptr)); }

const Scene* Publication::latest() {
  if (Entry* const taken = pending_.exchange(nullptr)) {
    if (Entry* const old = current_) {
      old->next = retired_.load();
      Entry* expected = old->next;
      if (!retired_.compare_exchange_strong(expected, old)) {
        // Only the editing thread can have changed the list, and that thread only empties it.
        old->next = nullptr;
        retired_.store(old);
      }
    }
    current_ = taken;
  }
  return current_ ? current_->scene.get() : nullptr;
}

void Publication::free_list(Entry* entry) {
  while (entry) {
    Entry* const next = entry->next;
    delete entry;
    entry = next;
  }
}

}  // namespace inkwell::contact
