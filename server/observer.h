// Observer: is told of every call when it has ended, and writes it into the log.

#ifndef RICOCHET_SERVER_OBSERVER_H_
#define RICOCHET_SERVER_OBSERVER_H_

#include "server/call_record.h"
#include "server/log.h"

namespace ricochet::server {

// Thread safety: every method may be called from several threads at once.
class Observer {
 public:
  // `log` must outlive the observer.
  explicit Observer(const Log& log) : log_(log) {}

  void Ended(const CallRecord& call) const;

 private:
  const Log& log_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_OBSERVER_H_
