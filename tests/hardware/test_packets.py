"""Packets against the e-manual's printed examples, and the reader against noise."""

from __future__ import annotations

import pytest
from dynamixel_sdk import PacketHandler
from hypothesis import given
from hypothesis import strategies as st

from enpointe.hardware.packets import (
    BROADCAST,
    Instruction,
    Packet,
    PacketReader,
    crc16,
    instruction_packet,
    status_packet,
    stuffed,
    unstuffed,
)

I = Instruction  # noqa: E741

INSTRUCTIONS = [
    (1, I.PING, "", "FF FF FD 00 01 03 00 01 19 4E"),
    (BROADCAST, I.PING, "", "FF FF FD 00 FE 03 00 01 31 42"),
    (1, I.READ, "84 00 04 00", "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15"),
    (1, I.WRITE, "74 00 00 02 00 00", "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89"),
    (1, I.REG_WRITE, "68 00 C8 00 00 00", "FF FF FD 00 01 09 00 04 68 00 C8 00 00 00 AE 8E"),
    (1, I.ACTION, "", "FF FF FD 00 01 03 00 05 02 CE"),
    (1, I.FACTORY_RESET, "01", "FF FF FD 00 01 04 00 06 01 A1 E6"),
    (1, I.REBOOT, "", "FF FF FD 00 01 03 00 08 2F 4E"),
    (1, I.CLEAR, "01 44 58 4C 22", "FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC"),
    (1, I.BACKUP, "01 43 54 52 4C", "FF FF FD 00 01 08 00 20 01 43 54 52 4C 16 F5"),
    (
        BROADCAST,
        I.SYNC_READ,
        "84 00 04 00 01 02",
        "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA",
    ),
    (
        BROADCAST,
        I.SYNC_WRITE,
        "74 00 04 00 01 96 00 00 00 02 AA 00 00 00",
        "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
    ),
    (
        BROADCAST,
        I.FAST_SYNC_READ,
        "84 00 04 00 03 07 04",
        "FF FF FD 00 FE 0A 00 8A 84 00 04 00 03 07 04 20 F2",
    ),
    (
        BROADCAST,
        I.BULK_READ,
        "01 90 00 02 00 02 92 00 01 00",
        "FF FF FD 00 FE 0D 00 92 01 90 00 02 00 02 92 00 01 00 1A 05",
    ),
    (
        BROADCAST,
        I.BULK_WRITE,
        "01 20 00 02 00 A0 00 02 1F 00 01 00 50",
        "FF FF FD 00 FE 10 00 93 01 20 00 02 00 A0 00 02 1F 00 01 00 50 B7 68",
    ),
]
STATUSES = [
    (1, "06 04 26", "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D"),
    (2, "06 04 26", "FF FF FD 00 02 07 00 55 00 06 04 26 6F 6D"),
    (1, "A6 00 00 00", "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0"),
    (2, "1F 08 00 00", "FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE"),
    (1, "", "FF FF FD 00 01 04 00 55 00 A1 0C"),
    (1, "77 00", "FF FF FD 00 01 06 00 55 00 77 00 C3 69"),
    (2, "24", "FF FF FD 00 02 05 00 55 00 24 8B A9"),
]


@pytest.mark.parametrize(("servo", "instruction", "parameters", "printed"), INSTRUCTIONS)
def test_instruction_packets_are_those_of_the_manual(
    servo: int, instruction: Instruction, parameters: str, printed: str
) -> None:
    content = bytes.fromhex(parameters)
    assert instruction_packet(servo, instruction, content) == bytes.fromhex(printed)
    assert list(PacketReader().feed(bytes.fromhex(printed))) == [
        Packet(servo, instruction, content)
    ]


@pytest.mark.parametrize(("servo", "parameters", "printed"), STATUSES)
def test_status_packets_are_those_of_the_manual(servo: int, parameters: str, printed: str) -> None:
    assert status_packet(servo, 0, bytes.fromhex(parameters)) == bytes.fromhex(printed)


def test_two_printed_checksums_are_the_manuals_own_mistakes() -> None:
    """Fast Bulk Read's request and Restore's; ours and the SDK's polynomial agree on others."""
    fast = instruction_packet(
        BROADCAST,
        I.FAST_BULK_READ,
        bytes.fromhex("03 84 00 04 00 07 7C 00 02 00 04 92 00 01 00"),
    )
    restore = instruction_packet(1, I.BACKUP, bytes.fromhex("02 43 54 52 4C"))
    sdk = PacketHandler(2.0)
    for packet, printed in ((fast, "20 F2"), (restore, "92 F5")):
        own = sdk.updateCRC(0, list(packet[:-2]), len(packet) - 2)
        assert packet[-2:] == own.to_bytes(2, "little") != bytes.fromhex(printed)


@given(st.binary(max_size=200), st.integers(0, 0xFFFF))
def test_the_checksum_is_that_of_the_sdk(data: bytes, start: int) -> None:
    assert crc16(data, start) == PacketHandler(2.0).updateCRC(start, list(data), len(data))


MARKED = st.lists(
    st.one_of(st.just(b"\xff\xff\xfd"), st.just(b"\xff"), st.just(b"\xfd"), st.binary(max_size=4)),
    max_size=12,
).map(b"".join)


@given(MARKED)
def test_stuffing_comes_off_and_leaves_no_header(body: bytes) -> None:
    wire = stuffed(body)
    assert unstuffed(wire) == body
    ends = [place + 3 for place in range(len(wire)) if wire[place : place + 3] == b"\xff\xff\xfd"]
    assert all(wire[end : end + 1] == b"\xfd" for end in ends)


@given(
    st.lists(st.tuples(st.integers(0, 252), st.sampled_from(Instruction), MARKED), max_size=5),
    st.lists(st.integers(1, 9), min_size=1, max_size=20),
    st.booleans(),
)
def test_packets_come_whole_out_of_any_cutting(
    sent: list[tuple[int, Instruction, bytes]], cuts: list[int], strict: bool
) -> None:
    stream = b"".join(instruction_packet(*each) for each in sent)
    reader = PacketReader(strict=strict)
    found, place, turn = [], 0, 0
    while place < len(stream):
        size = cuts[turn % len(cuts)]
        found += list(reader.feed(stream[place : place + size]))
        place, turn = place + size, turn + 1
    assert found == [Packet(*each) for each in sent]


@given(st.binary(max_size=30).filter(lambda noise: b"\xff\xff" not in noise + b"\x00"))
def test_the_reader_finds_its_feet_after_noise(noise: bytes) -> None:
    packet = instruction_packet(7, I.PING)
    assert list(PacketReader().feed(noise.rstrip(b"\xff") + packet))[-1] == Packet(7, I.PING, b"")


@given(st.integers(0, 15), st.integers(1, 255))
def test_a_damaged_packet_is_never_taken_for_a_sound_one(place: int, change: int) -> None:
    packet = bytearray(instruction_packet(1, I.WRITE, b"\x74\x00\x00\x02\x00\x00"))
    packet[place] ^= change
    assert not [each for each in PacketReader().feed(bytes(packet)) if each.sound]


def test_an_unstuffed_header_within_a_packet_is_taken_for_one_only_if_strict() -> None:
    """As the SDK sends it: it works out the stuffing and throws it away."""
    body = bytes([I.WRITE]) + bytes.fromhex("66 00 FF FF FD 11")
    raw = b"\xff\xff\xfd\x00\x01" + (len(body) + 2).to_bytes(2, "little") + body
    raw += crc16(raw).to_bytes(2, "little")
    assert list(PacketReader(strict=True).feed(raw)) == []
    assert list(PacketReader(strict=False).feed(raw)) == [Packet(1, I.WRITE, body[1:])]
