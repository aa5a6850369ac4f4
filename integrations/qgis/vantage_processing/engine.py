"""The package vantage: whether it is there, and calls of it that tell QGIS how they go."""

import contextlib
import sys

from qgis.core import QgsProcessingException

_HOW = ("Build its wheel (docs/python.md of vantage: make wheel) and install it for the Python that QGIS runs, "
        "{version}: {program} -m pip install vantage-*.whl; then start QGIS again.")


def _how():
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    return _HOW.format(version=version, program=f"python{version}")


try:
    import vantage as vt
except ImportError as error:
    vt = None
    PROBLEM = f"The Python package vantage cannot be imported ({error}). {_how()}"
else:
    PROBLEM = "" if hasattr(vt, "compute") else f"The module {vt.__file__} is another package named vantage. {_how()}"
    vt = None if PROBLEM else vt
"""PROBLEM: why the algorithms cannot run, and what to do about it; empty if they can."""


_STOPPED = "Stopped, as was asked: nothing was written."


def stop_if_canceled(feedback):
    """Before something is written: short calls of vantage end without asking whether to go on."""
    if feedback.isCanceled():
        raise QgsProcessingException(_STOPPED)


@contextlib.contextmanager
def told():
    """Errors of vantage become those of QGIS, with all that they say."""
    try:
        yield
    except vt.CancelledError as error:
        raise QgsProcessingException(_STOPPED) from error
    except vt.Error as error:
        raise QgsProcessingException(str(error)) from error


class Progress:
    """What vantage calls while it works: the stage, its part that is done, and whether to go on.

    `begin`, `end`: the part of the bar that a call has where there are several, 0 to 1.
    """

    def __init__(self, feedback, begin=0.0, end=1.0):
        self.feedback, self.begin, self.end = feedback, begin, end
        self._stage = None

    def __call__(self, stage, fraction):
        if stage != self._stage:
            self._stage = stage
            self.feedback.setProgressText(stage)
        self.feedback.setProgress(100 * (self.begin + (self.end - self.begin) * fraction))
        return not self.feedback.isCanceled()

    def part(self, begin, end):
        """The same for a part of the bar, which does not repeat the stage."""
        inner = Progress(self.feedback, begin, end)
        inner._stage = self._stage
        return inner


def tell_notes(feedback, notes):
    """What to know before relying on a result: `vantage.Note`s, or sentences."""
    for note in notes:
        feedback.pushWarning(getattr(note, "text", note))
