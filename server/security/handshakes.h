// Handshakes: tells in the log whose TLS handshake has failed, and why.
//
// gRPC says that a handshake has failed, but not whose. It makes the SSL object of a connection on the thread that
// hands the connection over, and frees it with the connection; OpenSSL reports both to whoever has extra data in such
// objects. An object that is freed before its handshake is finished is one that has failed. The reason is the alert by
// which one side has told the other (RFC 8446, sec. 6.2), or else the state in which the handshake has ended.
//
// A connection that ends without a byte from its client is one of those who only look whether the port is open: it is
// reported at the level of debugging.

#ifndef RICOCHET_SERVER_SECURITY_HANDSHAKES_H_
#define RICOCHET_SERVER_SECURITY_HANDSHAKES_H_

#include <string>

namespace ricochet::server {

// It attributes the handshakes that this thread begins to one peer, as long as it lives.
class HandshakesOf {
 public:
  // `peer` is the address of the client as records of calls have it, such as "ipv4:192.0.2.1:40000". Failures go to the
  // log that gRPC's own messages go to, as the warning "handshake failed".
  explicit HandshakesOf(std::string peer);
  ~HandshakesOf();
  HandshakesOf(const HandshakesOf&) = delete;
  HandshakesOf& operator=(const HandshakesOf&) = delete;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SECURITY_HANDSHAKES_H_
