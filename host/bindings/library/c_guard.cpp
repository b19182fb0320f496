#include "host/bindings/library/c_guard.hpp"

#include <exception>
#include <new>

#include "host/client/device/address.hpp"
#include "host/client/device/board_store.hpp"
#include "host/client/device/clear_fault.hpp"

#include "host/bindings/library/text_copy.hpp"

namespace inkwell::library {
namespace {

// A plain array remains valid when destructors call the library at program exit.
thread_local char error_text[sentence_maximum];

}  // namespace

inkwell_result refuse(inkwell_result result, const char* sentence) noexcept {
  copy_text(sentence, error_text);
  return result;
}

inkwell_result result_of_exception() noexcept {
  try {
    throw;
  } catch (const device::NoDevice& error) {
    return refuse(INKWELL_NO_DEVICE, error.what());
  } catch (const BadArgument& error) {
    return refuse(INKWELL_BAD_ARGUMENT, error.what());
  } catch (const device::BadAddress& error) {
    return refuse(INKWELL_BAD_ARGUMENT, error.what());
  } catch (const TimedOut& error) {
    return refuse(INKWELL_TIMED_OUT, error.what());
  } catch (const NotNow& error) {
    return refuse(INKWELL_REFUSED, error.what());
  } catch (const device::Refused& error) {
    return refuse(INKWELL_REFUSED, error.what());
  } catch (const device::NotStored& error) {
    return refuse(INKWELL_REFUSED, error.what());
  } catch (const device::FaultStays& error) {
    return refuse(INKWELL_REFUSED, error.what());
  } catch (const device::NotTested& error) {
    return refuse(INKWELL_REFUSED, error.what());
  } catch (const device::NoPermission& error) {
    return refuse(INKWELL_NO_PERMISSION, error.what());
  } catch (const device::Incompatible& error) {
    return refuse(INKWELL_INCOMPATIBLE, error.what());
  } catch (const device::Disconnected& error) {
    return refuse(INKWELL_DISCONNECTED, error.what());
  } catch (const ForceLost& error) {
    return refuse(INKWELL_FORCE_LOST, error.what());
  } catch (const device::InUse& error) {
    return refuse(INKWELL_IN_USE, error.what());
  } catch (const std::bad_alloc&) {
    return refuse(INKWELL_FAILED,
                  "The computer has too little free memory for this call. Close programs, or send less data.");
  } catch (const std::exception& error) {
    return refuse(INKWELL_FAILED, error.what());
  } catch (...) {
    return refuse(INKWELL_FAILED,
                  "An unexpected internal error occurred. Report this with the version of the library.");
  }
}

}  // namespace inkwell::library

const char* inkwell_error_text(void) { return inkwell::library::error_text; }
