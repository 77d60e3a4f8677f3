"""The command line."""

import argparse


def main() -> None:
    """Run the command line."""
    argparse.ArgumentParser(prog="groundplan").parse_args()
