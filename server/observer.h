// Observer: is told of every call when it has ended, and writes it into the log if the rule for calls says so.

#ifndef RICOCHET_SERVER_OBSERVER_H_
#define RICOCHET_SERVER_OBSERVER_H_

#include "server/call_record.h"
#include "server/call_rule.h"
#include "server/log.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class Observer {
 public:
  // `log` must outlive the observer.
  explicit Observer(const Log& log, const CallRule& rule = {}) : log_(log), sampler_(rule) {}

  void Ended(const CallRecord& call) const;

 private:
  const Log& log_;
  mutable CallSampler sampler_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_OBSERVER_H_
