"""An independent Modbus peer for the tests, by pymodbus: version 3.0 of Debian 12, whose registers may count from 0, and
3.8 of Debian 13, whose registers count from 1 and whose calls have other names.

usage: modbus_peer.py client tcp PORT|rtu DEVICE OPERATION...   OPERATION: input:A:N, holding:A:N, write:A:W[,W...],
                                                                both:A:W[,W...]:A:N; prints a line each
       modbus_peer.py slave tcp PORT|rtu DEVICE IDENTIFICATION   plays a power stage (hal/modbus/power_stage.hpp):
                                                                shows the velocity command as its velocity
"""

import logging
import sys
from inspect import signature

logging.disable(logging.CRITICAL)  # what it says of exceptions; the tests read those from the answers

pty_parity = "N"  # a pty has no parity bit, and refuses pyserial's second attempt to set one


def say(answer):
    print(f"exception {answer.exception_code}" if answer.isError() and hasattr(answer, "exception_code")
          else f"error {answer}" if answer.isError()
          else " ".join(map(str, getattr(answer, "registers", []))) or "done", flush=True)


def client(transport, place, operations):
    from pymodbus.client import ModbusSerialClient, ModbusTcpClient
    peer = (ModbusTcpClient("127.0.0.1", port=int(place)) if transport == "tcp"
            else ModbusSerialClient(place, baudrate=115200, parity=pty_parity, timeout=3))
    if not peer.connect():
        sys.exit("no connection")
    for operation in operations:
        kind, address, *rest = operation.split(":")
        address = int(address)
        if kind == "input":
            say(peer.read_input_registers(address, count=int(rest[0]), slave=1))
        elif kind == "holding":
            say(peer.read_holding_registers(address, count=int(rest[0]), slave=1))
        elif kind == "write":
            say(peer.write_registers(address, [int(w) for w in rest[0].split(",")], slave=1))
        elif kind == "both":
            words = [int(w) for w in rest[0].split(",")]
            written = ({"values": words, "slave": 1} if "values" in signature(peer.readwrite_registers).parameters
                       else {"write_registers": words, "unit": 1})
            say(peer.readwrite_registers(write_address=address, read_address=int(rest[1]), read_count=int(rest[2]),
                                         **written))
        else:
            sys.exit(f"unknown operation {operation}")
    peer.close()


def slave(transport, place, identification):
    from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
    from pymodbus.server import StartSerialServer, StartTcpServer
    try:
        from pymodbus.framer import FramerType
        rtu, first, mode = FramerType.RTU, 1, {}
    except ImportError:
        from pymodbus.transaction import ModbusRtuFramer
        rtu, first, mode = ModbusRtuFramer, 0, {"zero_mode": True}

    class Stage(ModbusSequentialDataBlock):
        def getValues(self, address, count=1):
            self.values[3] = (self.values[3] + 1) & 0xffff  # its cycle
            self.values[6:8] = self.values[18:20]
            return super().getValues(address, count)

    block = Stage(first, [identification, 1] + [0] * 30)
    context = ModbusServerContext(slaves=ModbusSlaveContext(hr=block, **mode), single=True)
    if transport == "tcp":
        StartTcpServer(context=context, address=("127.0.0.1", int(place)))
    else:
        StartSerialServer(context=context, framer=rtu, port=place, baudrate=115200, parity=pty_parity,
                          timeout=1)


if __name__ == "__main__":
    role, transport, place, *rest = sys.argv[1:]
    if role == "client":
        client(transport, place, rest)
    else:
        slave(transport, place, int(rest[0]))
