#include "tests/peers/peer.h"

namespace ricochet::peers {

Rod::Rod(const PendulumCase& c)
    : mass(3 * kInertiaAboutPin / (c.a * c.a + c.b * c.b)),
      inertia_com(kInertiaAboutPin / 4),
      com_x(c.a / 2),
      com_y(-c.b / 2),
      tip_x(c.a),
      tip_y(-c.b + kTipRadius) {}

}  // namespace ricochet::peers
