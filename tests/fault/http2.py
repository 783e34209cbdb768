"""A raw HTTP/2 client without manners: it sends the frames that a check asks for, and answers only what it is told to."""

import select
import socket
import struct
import threading
import time

import hpack

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
DATA, HEADERS, PRIORITY, RST_STREAM, SETTINGS, PUSH, PING, GOAWAY, WINDOW_UPDATE, CONTINUATION = range(10)
END_STREAM, ACK, END_HEADERS = 1, 1, 4
INITIAL_WINDOW_SIZE = 4
SERVICE = "/ricochet.v1.ImpactService/"


def frame(kind, flags, stream, payload=b""):
    return struct.pack(">I", len(payload))[1:] + struct.pack(">BBI", kind, flags, stream) + payload


def message(body, compressed=False, declared=None):
    """A gRPC message; `declared` is a length that need not be true."""
    return struct.pack(">BI", int(compressed), len(body) if declared is None else declared) + body


class Stream:
    def __init__(self):
        self.headers = {}
        self.credit = None  # Bytes of DATA that the server takes; None until it is first asked for.
        self.data = b""
        self.bytes = 0
        self.reset = None
        self.ended = False

    def status(self):
        """grpc-status as a number; None if there is none yet."""
        return int(self.headers["grpc-status"]) if "grpc-status" in self.headers else None

    def over(self):
        return self.ended or self.reset is not None


class RawConnection:
    """acknowledge: answer SETTINGS; pong: answer PING; credit: give back flow-control credit for DATA received; window:
    the initial window of each stream. `keep`: keep the bytes of DATA."""

    def __init__(self, host, port, acknowledge=True, pong=True, credit=True, window=65535, source=None, sock=None,
                 preface=True, keep=False, timeout_s=10):
        if sock is None:
            sock = socket.create_connection((host, port), timeout_s, source_address=(source, 0) if source else None)
        self.socket = sock
        self.socket.settimeout(timeout_s)
        self.authority = f"{host}:{port}"
        self.acknowledge, self.pong, self.credit, self.keep = acknowledge, pong, credit, keep
        self.encoder, self.decoder = hpack.Encoder(), hpack.Decoder()
        self.decoder.max_header_list_size = 1 << 20
        self.received = b""
        self.streams = {}
        self.next_stream = 1
        self.credit_left = 65535
        self.first_credit = 65535
        self.goaway = False
        self.closed = False
        self.pings = 0
        self.settings = 0
        self._block = b""
        if preface:
            self.send(PREFACE + frame(SETTINGS, 0, 0, struct.pack(">HI", INITIAL_WINDOW_SIZE, window)))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.closed = True
        self.socket.close()

    def send(self, data):
        """False if the peer has closed or takes no more."""
        try:
            self.socket.sendall(data)
            return True
        except OSError:
            self.closed = True
            return False

    def block(self, path, extra=()):
        return self.encoder.encode([
            (":method", "POST"), (":scheme", "http"), (":path", path), (":authority", self.authority),
            ("te", "trailers"), ("content-type", "application/grpc"), *extra])

    def open(self, path, body=None, extra=(), end=True):
        """Opens a stream; a body of None sends the headers alone. Returns its number."""
        stream = self.next_stream
        self.next_stream += 2
        self.streams[stream] = Stream()
        out = frame(HEADERS, END_HEADERS, stream, self.block(path, extra))
        if body is not None:
            payload = message(body)
            for start in range(0, len(payload), 16384):
                last = end and start + 16384 >= len(payload)
                out += frame(DATA, END_STREAM if last else 0, stream, payload[start:start + 16384])
        self.send(out)
        return stream

    def grant(self, stream, size):
        """Lets the server send this number of bytes more on a stream; 0 is the connection alone."""
        credit = struct.pack(">I", size)
        return self.send(b"".join(frame(WINDOW_UPDATE, 0, number, credit) for number in {0, stream}))

    def send_data(self, number, chunks, seconds=60, patience_s=60):
        """Sends pieces of at most 16 KiB on a stream as fast as the server gives credit; returns the bytes sent.

        Gives up after this time in all, or once there has been no credit for as long as the patience lasts.
        """
        stream = self.streams[number]
        sent = 0
        deadline = time.monotonic() + seconds
        for chunk in chunks:
            def may_send(size=len(chunk)):
                if stream.credit is None:
                    stream.credit = self.first_credit
                return min(stream.credit, self.credit_left) >= size

            self.read(0)
            until = min(deadline, time.monotonic() + patience_s)
            while not may_send() and not stream.over() and not self.closed and time.monotonic() < until:
                self.read(1, may_send)
            if stream.over() or not may_send() or not self.send(frame(DATA, 0, number, chunk)):
                break
            stream.credit -= len(chunk)
            self.credit_left -= len(chunk)
            sent += len(chunk)
        return sent

    def read(self, seconds, until=lambda: False):
        """Handles what the server sends until the condition holds, the time is over or the connection ends."""
        deadline = time.monotonic() + seconds
        while not self.closed and not until():
            left = max(0.0, deadline - time.monotonic())
            if not select.select([self.socket], [], [], left)[0]:
                break
            try:
                data = self.socket.recv(1 << 18)
            except OSError:
                data = b""
            if not data:
                self.closed = True
                break
            self.received += data
            self._handle()
        return until()

    def pump(self):
        """Goes on handling what the server sends, in a thread, until the connection is closed."""
        threading.Thread(target=lambda: self.read(3600), daemon=True).start()
        return self

    def answer(self, stream, seconds):
        """Waits for the end of a stream; returns it."""
        self.read(seconds, lambda: self.streams[stream].over())
        return self.streams[stream]

    def _handle(self):
        while len(self.received) >= 9:
            length = int.from_bytes(self.received[:3], "big")
            if len(self.received) < 9 + length:
                return
            kind, flags, number = self.received[3], self.received[4], int.from_bytes(self.received[5:9], "big")
            payload, self.received = self.received[9:9 + length], self.received[9 + length:]
            self._frame(kind, flags, number & 0x7FFFFFFF, payload)

    def _frame(self, kind, flags, number, payload):
        stream = self.streams.get(number)
        if kind == SETTINGS and not flags & ACK:
            self.settings += 1
            for kind_of, value in struct.iter_unpack(">HI", payload):
                if kind_of == INITIAL_WINDOW_SIZE:
                    for other in self.streams.values():
                        if other.credit is not None:
                            other.credit += value - self.first_credit
                    self.first_credit = value
            if self.acknowledge:
                self.send(frame(SETTINGS, ACK, 0))
        elif kind == PING and not flags & ACK:
            self.pings += 1
            if self.pong:
                self.send(frame(PING, ACK, 0, payload))
        elif kind == WINDOW_UPDATE:
            size = int.from_bytes(payload, "big")
            if number == 0:
                self.credit_left += size
            elif stream and stream.credit is not None:
                stream.credit += size
            elif stream:
                stream.credit = self.first_credit + size
        elif kind == GOAWAY:
            self.goaway = True
        elif kind == RST_STREAM and stream:
            stream.reset = int.from_bytes(payload, "big")
        elif kind == DATA:
            if stream:
                stream.bytes += len(payload)
                if self.keep:
                    stream.data += payload
            if self.credit and payload:
                credit = struct.pack(">I", len(payload))
                self.send(frame(WINDOW_UPDATE, 0, 0, credit) + frame(WINDOW_UPDATE, 0, number, credit))
        elif kind in (HEADERS, CONTINUATION):
            self._block += payload
            if flags & END_HEADERS:
                fields = dict(self.decoder.decode(self._block))
                self._block = b""
                if stream:
                    stream.headers.update(fields)
        if stream and kind in (DATA, HEADERS) and flags & END_STREAM:
            stream.ended = True
