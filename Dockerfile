# An image of the tool: `docker build -t retrolux .`, then
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/data" -w /data retrolux dataset run set
# Packages come from scripts/packages.txt by scripts/setup.sh, the same as on any Debian 12.
FROM debian:12 AS build
WORKDIR /opt/retrolux
# The list first: packages are installed again only when it changes.
COPY scripts/packages.txt scripts/setup.sh scripts/
RUN scripts/setup.sh packages && rm -rf /var/lib/apt/lists/*
COPY . .
RUN scripts/setup.sh && ln -s /opt/retrolux/build/release/cli/retrolux /usr/local/bin/retrolux
ENTRYPOINT ["retrolux"]
CMD ["--help"]
