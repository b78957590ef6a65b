#include "app/exit_code.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <system_error>

#include "base/errors.hpp"

namespace driftwright::app {
namespace {

/// Prints without allocating memory, also when standard error is full. A message may quote a file; of its control
/// characters only line breaks and tabs are printed, so that no file can command the terminal.
void say(const char* words, const char* what = "") noexcept {
  std::fputs(words, stderr);
  for (; *what != '\0'; ++what) {
    const auto byte = static_cast<unsigned char>(*what);
    const bool is_read = (byte >= 0x20U && byte != 0x7FU) || byte == '\n' || byte == '\t';
    std::fputc(is_read ? byte : ' ', stderr);
  }
  std::fputs("\n", stderr);
}

}  // namespace

ExitCode exit_code_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const InputError& e) {
    say("error: ", e.what());
    return kWrongInput;
  } catch (const RangeError& e) {
    say("error: ", e.what());
    return kWrongInput;
  } catch (const SolveError& e) {
    say("the numerics gave up: ", e.what());
    return kNumericsGaveUp;
  } catch (const EndedEarly& e) {
    say(e.what());
    return kEndedEarly;
  } catch (const std::bad_alloc&) {
    say("error: there is not enough memory; a coarser mesh, fewer fields or cyclograms, or `solver: {model: reduced}` take "
        "less");
    return kWrongInput;
  } catch (const std::filesystem::filesystem_error& e) {
    say("error: a file or folder cannot be used: ", e.what());
    return kWrongInput;
  } catch (const std::system_error& e) {
    say("error: the system cannot do what the program asks of it: ", e.what());
    return kWrongInput;
  } catch (const std::exception& e) {
    say("internal error: ", e.what());
    return kOurBug;
  } catch (...) {
    say("internal error: an exception of an unknown kind");
    return kOurBug;
  }
}

void end_with_words() {
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit of file size then fails and is reported
  std::set_terminate([] {
    const std::exception_ptr failure = std::current_exception();
    const ExitCode code = failure ? exit_code_of(failure) : kOurBug;
    if (code == kOurBug) std::abort();
    _exit(code);  // other threads are at work: no destructor may run
  });
}

}  // namespace driftwright::app
