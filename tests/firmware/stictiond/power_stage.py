"""A power stage that the drive reaches by Modbus TCP (hal/modbus/power_stage.hpp), played by the test: it stands still,
keeps no time and remembers every command, so that what it saw last is what the drive said last."""

import socket
import struct
import threading

IDENTIFICATION, SCHEMA = 0x5354, 1
READ_WRITE, WRITE, READ = 23, 16, 3
# Options of a drive for it: its loop of 10 ms is no faster than the simplest line.
ON_A_LINE = ("--set", "timing.fast_period=10 ms", "--set", "timing.slow_period=10 ms", "--set", "axis.X.max_velocity=0.04 m/s",
             "--set", "drive.real_time.priority=0")


class PowerStage:
    def __init__(self):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.listener.getsockname()[1]
        self.commands = []  # (function, control word), in the order of arrival
        self.closed = threading.Event()
        self.cycle = 0
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        connection, _ = self.listener.accept()
        try:
            while (header := self.exactly(connection, 7)) is not None:
                transaction, _, length, unit = struct.unpack(">HHHB", header)
                answer = self.answer(self.exactly(connection, length - 1))
                connection.sendall(struct.pack(">HHHB", transaction, 0, len(answer) + 1, unit) + answer)
        except (OSError, TypeError):
            pass  # the drive is gone
        self.closed.set()

    @staticmethod
    def exactly(connection, size):
        data = b""
        while len(data) < size:
            part = connection.recv(size - len(data))
            if not part:
                return None
            data += part
        return data

    def answer(self, pdu):
        function = pdu[0]
        if function == WRITE:
            self.commands.append((function, struct.unpack(">H", pdu[6:8])[0]))
            return pdu[:5]
        if function == READ_WRITE:
            self.commands.append((function, struct.unpack(">H", pdu[10:12])[0]))
        count = struct.unpack(">H", pdu[3:5])[0]
        self.cycle = (self.cycle + 1) & 0xFFFF
        enabled = self.enabled()
        words = struct.unpack(">10H", struct.pack(">4Hiff", IDENTIFICATION, SCHEMA, enabled << 4, self.cycle, 0, 0.0, 0.0))
        return struct.pack(">BB", function, 2 * count) + struct.pack(f">{count}H", *words[:count])

    def enabled(self):
        return bool(self.commands) and self.commands[-1][1] & 1 == 1

    def was_enabled(self):
        return any(control & 1 for _, control in self.commands)
