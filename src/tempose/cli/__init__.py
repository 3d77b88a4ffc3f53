"""The command line: one file a command, no mathematics."""

from tempose.cli.entry import main

__all__ = ["main"]
