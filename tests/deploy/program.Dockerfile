# One program of Debian in an image of its own, for compose_test.py where no registry is reached.
FROM debian:bookworm-slim
ARG PACKAGE
RUN apt-get update \
 && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$PACKAGE" \
 && rm -rf /var/cache/apt /var/lib/apt/lists/*
