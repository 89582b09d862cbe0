"""Arrays and attributes of HDF5 files that nobody trusts: sizes are checked before memory is taken."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.io.source_binary import SourceBinary

if TYPE_CHECKING:
    import h5py

#: Deflate makes no more than this many bytes from one.
LARGEST_COMPRESSION = 1032
#: An attribute of an object header is smaller than this.
LARGEST_ATTRIBUTE_BYTES = 2**16


@contextmanager
def open_hdf5(source: SourceBinary) -> Iterator[h5py.File]:
    """Open a file for reading; whatever is damaged in it becomes an error of one line.

    Parameters
    ----------
    source : SourceBinary

    Raises
    ------
    RecordingError
        If the file is cut off or damaged, at once or while it is read.
    """
    import h5py

    try:
        with h5py.File(source.path, "r") as file:
            yield file
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, OverflowError) as error:
        raise RecordingError(
            "the HDF5 file is damaged or cut off",
            file=source.name,
            expected="a whole HDF5 file",
            found=str(error).strip("'\"") or type(error).__name__,
        ) from error


def numeric_array(
    group: h5py.Group, name: str, *, kinds: str, columns: int | None, source: SourceBinary
) -> NDArray[Any]:
    """Read a data set of numbers whose declared size is backed by bytes in the file.

    Parameters
    ----------
    group : h5py.Group
    name : str
        Path of the data set inside the group.
    kinds : str
        Accepted NumPy kinds of number, such as ``"iu"`` for whole numbers.
    columns : int or None
        Number of columns, or None for one dimension.
    source : SourceBinary

    Returns
    -------
    ndarray, shape (n_rows,) or (n_rows, columns)

    Raises
    ------
    RecordingError
        If the data set is missing, has another shape or type, or is larger than what is stored.
    """
    import h5py

    place = name if name.startswith("/") else f"{group.name.rstrip('/')}/{name}"
    dataset = group.get(name)
    if not isinstance(dataset, h5py.Dataset):
        raise RecordingError(
            "a data set is missing",
            file=source.name,
            place=place,
            expected="an array of numbers",
            found=", ".join(group.keys()) or "an empty group",
        )
    shape = dataset.shape or ()
    wanted = "(n,)" if columns is None else f"(n, {columns})"
    fits = len(shape) == (1 if columns is None else 2) and shape[1:] in ((), (columns,))
    if not fits or dataset.dtype.kind not in kinds:
        raise RecordingError(
            "a data set has the wrong shape or type",
            file=source.name,
            place=place,
            expected=f"{wanted} {'whole ' if kinds == 'iu' else ''}numbers",
            found=f"{shape} of type {dataset.dtype}",
        )
    require_stored(dataset, source=source)
    values: NDArray[Any] = dataset[()]
    return values


def require_stored(dataset: h5py.Dataset, *, source: SourceBinary) -> None:
    """Refuse a data set that claims more bytes than the file can hold for it.

    Parameters
    ----------
    dataset : h5py.Dataset
        A chunked one must have all its chunks; what compression can hide is bounded too.
    source : SourceBinary

    Raises
    ------
    RecordingError
        If the claim is not backed by the file, or the data lie in another file.
    """
    claimed = prod(int(n) for n in dataset.shape or ()) * dataset.dtype.itemsize
    if dataset.is_virtual or dataset.external:
        found = "data in other files"
    else:
        stored = min(dataset.id.get_storage_size(), source.size)
        compressed = dataset.id.get_create_plist().get_nfilters() > 0
        limit = stored * LARGEST_COMPRESSION if compressed else stored
        whole = True
        if dataset.chunks and claimed:
            chunks = prod(
                -(-n // size) for n, size in zip(dataset.shape, dataset.chunks, strict=True)
            )
            whole = dataset.id.get_num_chunks() >= chunks
        if claimed <= limit and whole:
            return
        found = f"{stored} bytes stored"
    raise RecordingError(
        "the file does not hold what it declares",
        file=source.name,
        place=dataset.name,
        expected=f"{claimed} bytes for {dataset.shape}",
        found=found,
    )


def small_attribute(item: h5py.HLObject, name: str, *, source: SourceBinary) -> Any:
    """Value of an attribute, or None; one that claims more than an attribute holds is refused.

    Parameters
    ----------
    item : h5py.HLObject
        Group, data set or file.
    name : str
    source : SourceBinary

    Raises
    ------
    RecordingError
        If its size is impossible.
    """
    if name not in item.attrs:
        return None
    size = item.attrs.get_id(name).get_storage_size()
    if size > LARGEST_ATTRIBUTE_BYTES:
        raise RecordingError(
            "the file does not hold what it declares",
            file=source.name,
            place=f"{item.name} attribute {name}",
            expected=f"at most {LARGEST_ATTRIBUTE_BYTES} bytes",
            found=f"{size} bytes",
        )
    return item.attrs[name]


def padded_texts(value: Any) -> list[str]:
    r"""Texts of an attribute or data set: bytes padded with NUL or spaces, one or several.

    Parameters
    ----------
    value : bytes, str, array of them, or None

    Examples
    --------
    >>> padded_texts(b"Left Foot\x00\x00  "), padded_texts(np.array([b"a ", b"b"])), padded_texts(None)
    (['Left Foot'], ['a', 'b'], [])
    """
    if value is None or isinstance(value, np.void):
        return []
    items = np.atleast_1d(np.asarray(value, dtype=object)).ravel().tolist()
    texts = [
        item.decode("utf-8", "replace") if isinstance(item, bytes) else str(item) for item in items
    ]
    return [text.split("\x00")[0].strip() for text in texts]
