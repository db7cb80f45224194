#include "cad/detail/occt_guard.h"

#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Controller.hxx>

#include "base/sanitized.h"

namespace catoptric::cad::detail {
namespace {

std::mutex& exchange_mutex() {
  static std::mutex mutex;
  return mutex;
}

bool is_child_process = false;

std::unique_lock<std::mutex> lock_exchange() {
  return is_child_process ? std::unique_lock<std::mutex>() : std::unique_lock(exchange_mutex());
}

/// Loads the exchange tables once and keeps OCCT from writing to standard output. Called under the lock.
void start_exchange() {
  static const bool started = [] {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
    STEPControl_Controller::Init();
    IGESControl_Controller::Init();
    return true;
  }();
  static_cast<void>(started);
}

}  // namespace

void throw_occt_failure(std::string_view doing, std::string_view where, const Standard_Failure& failure) {
  std::string why = failure.DynamicType()->Name();
  const char* message = failure.GetMessageString();
  if (message != nullptr && *message != '\0') why += std::string(" (") + message + ")";
  throw_cad_error(doing, where, why);
}

void throw_cad_error(std::string_view doing, std::string_view where, std::string_view why) {
  throw CadError({"OpenCASCADE could not " + std::string(doing), std::string(where), std::string(why),
                  "check that the profile has no repeated, crossing or nearly coincident points"});
}

ExchangeSession::ExchangeSession() : lock_(lock_exchange()) { start_exchange(); }

void ExchangeSession::enter_child_process() { is_child_process = true; }

ExchangeSession::~ExchangeSession() {
  for (auto setting = before_.rbegin(); setting != before_.rend(); ++setting)
    Interface_Static::SetCVal(setting->first.c_str(), setting->second.c_str());
}

void ExchangeSession::remember(const std::string& name) {
  if (!Interface_Static::IsPresent(name.c_str()))
    throw CadError({"OpenCASCADE has no setting " + name, "", "another release than 7.6 may be installed",
                    "install the release the README names"});
  before_.emplace_back(name, Interface_Static::CVal(name.c_str()));
}

void ExchangeSession::set(const std::string& name, const std::string& value) {
  remember(name);
  if (!Interface_Static::SetCVal(name.c_str(), value.c_str()))
    throw CadError({"OpenCASCADE refuses " + name + " = " + value, "", "", "check the value"});
}

void ExchangeSession::set(const std::string& name, int value) {
  remember(name);
  if (!Interface_Static::SetIVal(name.c_str(), value))
    throw CadError(
        {"OpenCASCADE refuses " + name + " = " + std::to_string(value), "", "", "check the value"});
}

}  // namespace catoptric::cad::detail

#ifdef CATOPTRIC_ADDRESS_SANITIZED
/// OCCT's exchange tables and STEP writer forget some 4 kB; what our own code forgets is still found.
extern "C" const char* __lsan_default_suppressions() { return "leak:libTK"; }
/// Quiet runs print nothing, sanitized or not.
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif
