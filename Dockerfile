# Both commands of the README on a bare Debian:
#   docker build -t rtg .
#   docker run --rm -v "$PWD/runs:/rtg/runs" rtg
#   docker run --rm --privileged rtg ./test.sh    # some tests make a network of their own
FROM debian:12
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates git
WORKDIR /rtg
COPY . .
RUN ./run.sh --print-config > /dev/null
CMD ["./run.sh"]
