#pragma once

#include <Standard_Failure.hxx>
#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/float_traps.h"

namespace catoptric::cad::detail {

/// What every failure inside OCCT becomes; `doing` is what we were about, `where` the file or part.
[[noreturn]] void throw_occt_failure(std::string_view doing, std::string_view where,
                                     const Standard_Failure& failure);
[[noreturn]] void throw_cad_error(std::string_view doing, std::string_view where, std::string_view why);

/// Runs `work` and turns whatever OCCT throws to CadError. Our own errors and broken contracts pass
/// unchanged. Standard_Failure is no std::exception, so this is the one place that catches it.
/// @fails CadError
template <typename Work>
decltype(auto) guarded(std::string_view doing, std::string_view where, Work&& work) {
  const UntrappedFloats untrapped;  // OCCT's boxes and domains have infinite ends
  try {
    return std::forward<Work>(work)();
  } catch (const Error&) {
    throw;
  } catch (const std::logic_error&) {
    throw;
  } catch (const Standard_Failure& failure) {
    throw_occt_failure(doing, where, failure);
  } catch (const std::bad_alloc&) {
    throw_cad_error(doing, where, "there is not enough memory");
  } catch (const std::exception& failure) {
    throw_cad_error(doing, where, failure.what());
  }
}

/// Sole use of OCCT's readers and writers for as long as it lives: holds the one lock of all exchange (their
/// settings are process-wide and two writers at once crash), has their tables loaded and their printers
/// silent, and puts every setting it changed back.
class ExchangeSession {
 public:
  ExchangeSession();
  ~ExchangeSession();
  ExchangeSession(const ExchangeSession&) = delete;
  ExchangeSession& operator=(const ExchangeSession&) = delete;

  /// Sets an Interface_Static parameter until the session ends.
  /// @fails CadError when OCCT knows no such parameter or refuses the value
  void set(const std::string& name, const std::string& value);
  void set(const std::string& name, int value);

  /// Called first in a forked child, which inherits its parent's lock and is alone.
  static void enter_child_process();

 private:
  void remember(const std::string& name);

  std::unique_lock<std::mutex> lock_;
  std::vector<std::pair<std::string, std::string>> before_;
};

}  // namespace catoptric::cad::detail
