#include "daemon/threads/guarded_thread.hpp"

#include <pthread.h>

#include <exception>

namespace hulltrack {

GuardedThread::GuardedThread(std::string name, Body body, OnFailure on_failure, std::function<void()> on_stop)
    : on_stop_(std::move(on_stop)),
      thread_([name = std::move(name), body = std::move(body),
               on_failure = std::move(on_failure)](const std::stop_token& stop) {
        pthread_setname_np(pthread_self(), name.substr(0, 15).c_str());
        try {
          body(stop);
        } catch (const std::exception& error) {
          on_failure(name, error.what());
        } catch (...) {
          on_failure(name, "an exception of unknown type");
        }
      }) {}

GuardedThread::~GuardedThread() { stop(); }

void GuardedThread::stop() {
  if (!thread_.joinable()) {
    return;
  }
  thread_.request_stop();
  if (on_stop_) {
    on_stop_();
  }
  thread_.join();
}

}  // namespace hulltrack
