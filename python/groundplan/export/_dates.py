"""The date that a format wants to have."""

from __future__ import annotations

import os
from datetime import UTC, datetime

from groundplan._errors import ParameterError


def moment(date: str | datetime | None) -> datetime:
    """A date in UTC, to the second: what is given, else SOURCE_DATE_EPOCH, else now.

    Parameters
    ----------
    date
        ISO 8601, such as ``2026-05-01`` or ``2026-05-01T09:30:00+02:00``; UTC where it names no zone.

    Raises
    ------
    ParameterError
        ``export.date``.
    """
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    try:
        if date is None:
            found = datetime.now(UTC) if not epoch else datetime.fromtimestamp(int(epoch), UTC)
        else:
            found = date if isinstance(date, datetime) else datetime.fromisoformat(date)
    except (ValueError, OverflowError, OSError) as fault:
        said = f"the date {date!r}" if date is not None else f"SOURCE_DATE_EPOCH={epoch!r}"
        raise ParameterError("export.date", f"{said} is no date", "such as 2026-05-01 or 2026-05-01T09:30Z") from fault
    found = found.replace(tzinfo=UTC) if found.tzinfo is None else found.astimezone(UTC)
    return found.replace(microsecond=0)
