import subprocess
import time

from processes import freeze, is_stopped


def test_a_pause_stops_a_process_that_lives_and_tells_of_one_that_has_ended() -> None:
    words = ["sh", "-c", "echo starts; read line; echo ends"]
    process = subprocess.Popen(words, stdin=-1, stdout=-1, text=True)
    assert process.stdout is not None and process.stdout.readline() == "starts\n"
    begin = time.monotonic()
    assert not is_stopped(process.pid)
    assert freeze(process, 0.1) and time.monotonic() - begin >= 0.1
    assert process.communicate("\n")[0] == "ends\n"  # it goes on afterwards
    assert not freeze(process, 100.0)
