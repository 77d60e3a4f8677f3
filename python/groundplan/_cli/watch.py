"""groundplan watch: the survey of a live topic, kept up to date."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from groundplan._cli import terminal
from groundplan._cli.arguments import number, place, share
from groundplan._cli.survey import add_method, printable, refuse_nothing, settings

if TYPE_CHECKING:
    from groundplan.maps import Map
    from groundplan.maps.live import Topic
    from groundplan.survey import Survey

#: Where the survey goes on the network unless another topic is named.
PUBLISHED = "/groundplan/survey"


def fill(own: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    own.usage = "groundplan watch [--topic NAME] [-o DIR] [--once] [--publish] [flags]"
    own.epilog = (
        "It listens on the network that CYCLONEDDS_URI names, without a ROS installation. survey.json is put in place "
        "whole with each change: whoever reads it never sees half of one."
    )
    own.add_argument("--topic", default="/map", metavar="NAME", help="the topic with the map (default: /map)")
    own.add_argument("--domain", type=domain, metavar="N", help="the DDS domain (default: ROS_DOMAIN_ID, or 0)")
    own.add_argument(
        "-o",
        "--out",
        metavar="DIR",
        type=place,
        help="where survey.json goes (default: the topic's last name with -survey, in the current directory)",
    )
    own.add_argument(
        "--publish",
        nargs="?",
        const=PUBLISHED,
        metavar="TOPIC",
        help=f"publish the JSON too, as std_msgs/String, kept for late subscribers (default: {PUBLISHED})",
    )
    own.add_argument("--once", action="store_true", help="end after the first survey")
    own.add_argument("--timeout", type=seconds, metavar="S", help="end when nothing came for so long, s")
    own.add_argument("-q", "--quiet", action="store_true", help="no talk, no warnings: only errors are told")
    add_method(own)
    group = own.add_argument_group("reading the map")
    group.add_argument(
        "--occupied-thresh", type=share, metavar="P", help="occupied from here on, 0 to 1 (default: .65)"
    )
    group.add_argument("--free-thresh", type=share, metavar="P", help="free up to here, 0 to 1 (default: .25)")


def seconds(text: str) -> float:
    """A time to wait."""
    value = number(text)
    if not 0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of seconds above 0")
    return value


def domain(text: str) -> int:
    """A DDS domain."""
    from groundplan._errors import MapError
    from groundplan.maps.live import domain_of

    try:
        return domain_of(int(text) if text.isdecimal() else -1)
    except MapError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a DDS domain, 0 to 232") from None


def run(arguments: argparse.Namespace) -> None:
    """Survey each map that comes."""
    from groundplan._errors import MapError
    from groundplan.maps.live import Topic

    chosen = settings(arguments)
    thresholds = {"occupied_thresh": arguments.occupied_thresh, "free_thresh": arguments.free_thresh}
    last: Survey | None = None
    with Topic(arguments.topic, arguments.domain, **thresholds) as topic, terminal.status(arguments.quiet) as status:
        name = topic.name.rpartition("/")[2]
        out = Path(f"{name}-survey") if arguments.out is None else Path(arguments.out)
        while True:
            status(f"waiting for {topic.name}")
            try:
                map = topic.next(arguments.timeout)
                if map is None:
                    break
                refuse_nothing(map, topic.name)
            except MapError as fault:
                if arguments.once:
                    raise
                status.clear()
                terminal.say("warning", f"{fault} [{fault.code}]")
                continue
            last = keep(arguments, topic, map, out, chosen, status, last)
            if arguments.once:
                return
        if last is None:
            raise nothing_came(topic, arguments.timeout)


def keep(
    arguments: argparse.Namespace,
    topic: Topic,
    map: Map,
    out: Path,
    chosen: dict[str, Any],
    status: terminal.Status,
    last: Survey | None,
) -> Survey:
    """Survey a map, write the survey, publish it and say so; of the last map only what changed is looked for anew."""
    import dataclasses

    import groundplan
    from groundplan._files import write_text

    since = time.monotonic()
    threads = arguments.threads

    def surveyed() -> Survey:
        if last is not None:
            return last.update(map, threads=threads)
        return groundplan.survey(map, threads=threads, keep=not arguments.once, **chosen)

    made = terminal.working(status, f"surveying {topic.name}", surveyed)
    named = dataclasses.replace(made.map, image=printable(arguments.name or made.map.image))
    found = dataclasses.replace(made, map=named)
    text = found.to_json()
    write_text(out / "survey.json", text)
    if arguments.publish is not None:
        topic.publish(arguments.publish, text)
    if arguments.quiet:
        return made
    status.clear()
    for warning in found.warnings:
        terminal.say("warning", f"{warning.message} [{warning.code}]")
    size = f"{map.width} x {map.height} pixels, {len(found.walls)} walls, {len(found.labels)} labels"
    terminal.say("surveyed", f"{topic.name}: {size}, {time.monotonic() - since:.2f} s")
    terminal.say("wrote", str(out / "survey.json"))
    return made


def nothing_came(topic: Topic, timeout: float) -> Exception:
    """The error that says what was heard instead."""
    from groundplan._errors import MapError

    heard = topic.heard()
    listed = ", ".join(heard) if heard else "none"
    said = f"no map came on {topic.name} of domain {topic.domain} within {timeout:g} s; topics heard: {listed}"
    return MapError("map.timeout", said, "ROS_DOMAIN_ID and CYCLONEDDS_URI must be those of the robot")
