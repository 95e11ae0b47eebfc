// SPDX-License-Identifier: MIT
#include "apps/runtime/stop_signals.h"

#include <unistd.h>

#include <csignal>

namespace corral {
namespace {

/// A signal that the program was started to ignore (nohup, a background job of a script) stays ignored.
sigset_t stopping_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  sigaddset(&signals, SIGUSR1);  // ends the waiting
  return signals;
}

}  // namespace

StopSignals::StopSignals(std::function<void()> on_stop) : on_stop_(std::move(on_stop)) {
  const sigset_t signals = stopping_signals();
  pthread_sigmask(SIG_BLOCK, &signals, &before_);  // the thread below and all later ones inherit it
  waiting_ = std::thread([this, signals] {
    int signal = 0;
    while (sigwait(&signals, &signal) == 0 && !is_over_) {
      if (signal == SIGUSR1) continue;
      on_stop_();
      ::_exit(128 + signal);
    }
  });
}

StopSignals::~StopSignals() {
  is_over_ = true;
  pthread_kill(waiting_.native_handle(), SIGUSR1);
  waiting_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace corral
