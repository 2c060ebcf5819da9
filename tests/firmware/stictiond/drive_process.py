"""A running `stictiond` with one simulated axis, and a Modbus client of it: what the tests of the programme's end share.

The axis runs in its own time (`--unpaced`), so that no load of this machine makes a tick late.
"""

import os
import pathlib
import signal as signals
import socket
import struct
import subprocess
import time

BIN = pathlib.Path(os.environ["STICTION_BIN"])
PATIENCE = 60.0  # s, for what another process must do; far more than a busy machine needs
CONTROLWORD, STATUSWORD, COMMISSIONING_TIME = 100, 100, 16
ENABLED, STATE_MASK = 0x27, 0x6F


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def comes_true(condition):
    """Waits for it; false where it does not come."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.01)
    return False


class Client:
    """A Modbus TCP client. A refused request raises Refused with the exception's code."""

    class Refused(Exception):
        pass

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)

    def close(self):
        self.socket.close()

    def send(self, pdu):
        self.socket.sendall(struct.pack(">HHHB", 1, 0, len(pdu) + 1, 1) + pdu)

    def receive(self):
        def exactly(size):
            data = b""
            while len(data) < size:
                part = self.socket.recv(size - len(data))
                if not part:
                    raise ConnectionError("the drive closed the connection")
                data += part
            return data
        pdu = exactly(struct.unpack(">HHHB", exactly(7))[2] - 1)
        if pdu[0] & 0x80:
            raise Client.Refused(pdu[1])
        return pdu

    def ask(self, pdu):
        self.send(pdu)
        return self.receive()

    def read(self, address, count=1, function=4):
        return struct.unpack(f">{count}H", self.ask(struct.pack(">BHH", function, address, count))[2:])

    def read_float(self, address, function=4):
        return struct.unpack(">f", struct.pack(">2H", *self.read(address, 2, function)))[0]

    def write(self, address, value):
        self.ask(struct.pack(">BHH", 6, address, value))

    def write_float(self, address, value):
        self.ask(struct.pack(">BHHBf", 16, address, 2, 4, value))

    def state(self):
        return self.read(STATUSWORD)[0] & STATE_MASK

    def enable(self):
        for word, state in ((6, 0x21), (7, 0x23), (15, ENABLED)):
            self.write(CONTROLWORD, word)
            assert comes_true(lambda state=state: self.state() == state), f"state {self.state():#x} after {word}"


class Drive:
    """The process. `log`: a file descriptor or subprocess.PIPE for standard error; `options`: further ones; `settings`: of
    a drive that serves. Its clients are not watched: they do not write each second of the drive's own time."""

    def __init__(self, *options, log=subprocess.PIPE, out=subprocess.PIPE, hal=("simulated", "--unpaced"),
                 command=(), machine="emps", serve=True, settings=(), **more):
        self.port = free_port()
        served = ("--set", f"drive.modbus_server.address=127.0.0.1:{self.port}",
                  "--set", "drive.modbus_server.motion=allowed", "--set", "drive.modbus_server.commander_timeout=0 s",
                  *settings) if serve else ()
        self.process = subprocess.Popen(
            [*command, BIN / "stictiond", "--machine", machine, "--hal", *hal, *served, *options],
            stdout=out, stderr=log, **more)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        for stream in (self.process.stdout, self.process.stderr):
            if stream is not None:
                stream.close()

    def client(self):
        """Connects as soon as the drive listens."""
        found = []

        def connects():
            try:
                found.append(Client(self.port))
            except ConnectionRefusedError:
                assert self.process.poll() is None, f"the drive ended with {self.process.returncode}"
                return False
            return True
        assert comes_true(connects), "the drive does not listen"
        return found[0]

    def open_commissioning(self, client):
        """As an operator: clients may write parameters."""
        self.process.send_signal(signals.SIGUSR1)
        assert comes_true(lambda: client.read(COMMISSIONING_TIME, 2)[1] > 0), "the window does not open"

    def end(self, signal=None):
        """Its exit status, after `signal`; raises subprocess.TimeoutExpired where it does not end."""
        if signal is not None:
            self.process.send_signal(signal)
        return self.process.wait(PATIENCE)
