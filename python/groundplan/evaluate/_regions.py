"""How well the regions of a survey agree with a truth: rooms pixel by pixel, halls by their outlines."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from groundplan._errors import MapError
from groundplan._polygons import fill
from groundplan.evaluate._scores import matches, optional

Labels = npt.NDArray[np.int64]

_HALL = 0.7  # least intersection over union of a region and the hall that it is
_LEAST = 100  # pixels; a region that has no more is left out on both sides (Bormann et al. 2016)
_FREE = 250  # grey from which a map of theirs is free, and above which a ground truth is a room


def read_truth(path: Path) -> Labels:
    """A ground truth picture as labels 1, 2, ..: every 8-connected piece lighter than 250 is a room; 0 is none."""
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(path) as image:
            grey = np.array(image.convert("L"))
    except (OSError, UnidentifiedImageError) as fault:
        raise MapError("image.read", f"cannot read {path}: {fault}") from fault
    return truth_labels(grey)


def truth_labels(grey: npt.NDArray[np.uint8]) -> Labels:
    """The same of an image's pixels."""
    labels, _ = optional("scipy.ndimage").label(grey > _FREE, structure=np.ones((3, 3)))
    return _without_small(np.asarray(labels))


def region_labels(survey: dict[str, Any], pixels: npt.NDArray[np.uint8]) -> Labels:
    """The survey's regions drawn on the map's free pixels (grey 250 and more), 1, 2, .. in their order.

    A pixel is a region's where its centre lies in the polygon. OpenCV's ``fillPoly``, by which the published script
    draws, also takes the pixels that the outline only touches: up to a pixel more along an outline that is not on
    free floor's edge, and where two regions meet the later one wins there.
    """
    x0, y0, yaw = survey["map"]["origin"]
    resolution, height = survey["map"]["resolution"], pixels.shape[0]
    c, s = math.cos(yaw), math.sin(yaw)

    def drawn(ring: list[list[float]]) -> npt.NDArray[np.float64]:
        p = np.array(ring, dtype=float).reshape(-1, 2) - (x0, y0)
        x, y = c * p[:, 0] + s * p[:, 1], c * p[:, 1] - s * p[:, 0]
        corners: npt.NDArray[np.float64] = np.stack([x / resolution, height - y / resolution], axis=1)
        return corners

    labels = np.zeros(pixels.shape, dtype=np.int64)
    free = pixels >= _FREE
    regions = [label for label in survey["labels"] if label["kind"] == "region"]
    for number, region in enumerate(regions, start=1):
        rings = [drawn(ring) for ring in (region["polygon"], *region.get("holes", []))]
        labels[fill(rings, (height, pixels.shape[1])) & free] = number
    return _without_small(labels)


def _without_small(labels: Labels) -> Labels:
    """Labels numbered anew, without those of too few pixels."""
    values, inverse, counts = np.unique(labels, return_inverse=True, return_counts=True)
    kept = (values != 0) & (counts > _LEAST)
    fresh = np.zeros(values.size, dtype=np.int64)
    fresh[kept] = np.arange(1, int(kept.sum()) + 1)
    result: Labels = fresh[inverse].reshape(labels.shape)
    return result


def region_scores(found: Labels, true: Labels) -> dict[str, Any]:
    """Agreement of two label images of one shape.

    Returns
    -------
    dict
        iou_1to1
            The greatest sum of intersection over union that a one-to-one assignment has, over the greater number
            of regions: every split and every merge costs.
        mcc
            Matthews correlation, mean over pairs and what is left over, after MAORIS (Mielle et al.): only pixels
            labelled on both sides count, and regions are paired greedily by their overlap.
        rooms, regions
            How many there are in truth, and how many were found.
    """
    rooms, regions = int(true.max(initial=0)), int(found.max(initial=0))
    result: dict[str, Any] = {"iou_1to1": 0.0, "mcc": 0.0, "rooms": rooms, "regions": regions}
    if not rooms or not regions:
        return result
    pairs = np.bincount((found * (rooms + 1) + true).ravel(), minlength=(regions + 1) * (rooms + 1))
    table = pairs.reshape(regions + 1, rooms + 1).astype(float)
    both = table[1:, 1:]
    union = table.sum(axis=1)[1:, None] + table.sum(axis=0)[None, 1:] - both
    iou = both / union
    rows, columns = optional("scipy.optimize").linear_sum_assignment(-iou)
    result["iou_1to1"] = round(float(iou[rows, columns].sum()) / max(rooms, regions), 4)
    result["mcc"] = round(_correlation(both), 4)
    return result


def _correlation(both: npt.NDArray[np.float64]) -> float:
    """Mean Matthews correlation of regions (rows) and rooms (columns) that share `both` pixels."""
    both = both[both.sum(axis=1) > 0][:, both.sum(axis=0) > 0]
    if not both.size:
        return 0.0
    rows, columns = both.sum(axis=1), both.sum(axis=0)
    left_rows, left_columns, figures = set(range(rows.size)), set(range(columns.size)), []
    for flat in np.argsort(-both, axis=None).tolist():
        row, column = divmod(flat, columns.size)
        if both[row, column] <= 0:
            break
        if row in left_rows and column in left_columns:
            left_rows.remove(row)
            left_columns.remove(column)
            figures.append(_matthews(both[row, column], rows[row], columns[column], both.sum()))
    return math.fsum(figures) / (len(figures) + len(left_rows) + len(left_columns))


def _matthews(shared: float, row: float, column: float, whole: float) -> float:
    """Of two sets of pixels: how many they share, how many each has, and how many there are."""
    spread = row * column * (whole - column) * (whole - row)
    apart = shared * (whole - row - column + shared) - (row - shared) * (column - shared)
    return float(apart / math.sqrt(spread)) if spread > 0 else 0.0


def hall_scores(survey: dict[str, Any], truth: dict[str, Any]) -> dict[str, Any]:
    """Recall and precision of regions as halls, matched one to one where their outlines have an IoU of 0.7 at least.

    Of the regions those count that lie in halls with half of their ground, holes left out, as racks stand in these.
    Halls that were not observed count neither way, nor what lies in them. None where there is nothing to ask.
    """
    geometry = optional("shapely.geometry")
    asked, unseen = (
        [geometry.Polygon(hall["polygon"]).buffer(0) for hall in truth["halls"] if hall["observed"] is seen]
        for seen in (True, False)
    )
    given = [geometry.Polygon(label["polygon"]).buffer(0) for label in survey["labels"] if label["kind"] == "region"]

    def within(region: Any, halls: list[Any]) -> bool:
        return bool(sum(region.intersection(hall).area for hall in halls) > region.area / 2)

    mine = [region for region in given if within(region, asked) and not within(region, unseen)]
    shares = [[hall.intersection(region).area / hall.union(region).area for region in mine] for hall in asked]
    overlap = np.array(shares, dtype=float).reshape(len(asked), len(mine))
    right = matches(1.0 - overlap, overlap >= _HALL) if overlap.size else 0
    return {
        "hall_recall": round(right / len(asked), 4) if asked else None,
        "hall_precision": round(right / len(mine), 4) if mine else None,
    }
